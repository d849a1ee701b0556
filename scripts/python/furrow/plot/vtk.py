"""Frames as VTK PolyData files, written without VTK: XML with compressed arrays in base64 [VTK User's Guide, "VTK XML
Formats"]."""
from __future__ import annotations

import base64
import pathlib
import zlib
from collections.abc import Iterable, Mapping
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from .frames import Frame, GrainFrame, TireFrame

TYPES = {"f4": "Float32", "f8": "Float64", "i4": "Int32", "i8": "Int64"}
Array = NDArray[Any]


def data_array(name: str, values: Array) -> str:
    """<DataArray>: as UInt64 one block, its bytes, no rest, its bytes compressed; then the block; little-endian."""
    values = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    kind = TYPES[f"{values.dtype.kind}{values.dtype.itemsize}"]
    columns = values.shape[1] if values.ndim == 2 else 1
    packed = zlib.compress(values.tobytes(), 1)
    head = [1, values.nbytes, 0, len(packed)] if values.nbytes else [0, 0, 0]
    content = (base64.b64encode(np.array(head, "<u8").tobytes())
               + base64.b64encode(packed if values.nbytes else b"")).decode()
    return (f'<DataArray type="{kind}" Name={quoteattr(name)} NumberOfComponents="{columns}" '
            f'format="binary">{content}</DataArray>')


def polydata(position: Array, cells: Mapping[str, Array], values: Mapping[str, Array], time: float) -> str:
    """One file. `cells` are {"Polys": (m, 3) indices} or {"Verts": (n, 1)}, `values` arrays over the points."""
    counts = " ".join(f'NumberOf{kind}="{len(cells.get(kind, ()))}"' for kind in ("Verts", "Lines", "Strips", "Polys"))
    parts = ["<PointData>", *(data_array(name, array) for name, array in values.items()), "</PointData>",
             "<Points>", data_array("position", position.astype("f4")), "</Points>"]
    for kind, corners in cells.items():
        ends = corners.shape[1] * np.arange(1, len(corners) + 1, dtype="i4")
        parts += [f"<{kind}>", data_array("connectivity", corners.astype("i4").ravel()),
                  data_array("offsets", ends), f"</{kind}>"]
    return "\n".join(['<?xml version="1.0"?>', '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" '
                      'header_type="UInt64" compressor="vtkZLibDataCompressor">', "<PolyData>", "<FieldData>",
                      '<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" '
                      f'format="ascii">{time:.17g}</DataArray>', "</FieldData>",
                      f'<Piece NumberOfPoints="{len(position)}" {counts}>', *parts, "</Piece>", "</PolyData>",
                      "</VTKFile>", ""])


def text_of(frame: Frame) -> str:
    """A frame as the text of a .vtp file."""
    if isinstance(frame, TireFrame):
        values = {"velocity": frame.velocity, "force": frame.force}
        if frame.strain is not None:
            values["strain"] = frame.strain
        return polydata(frame.position, {"Polys": frame.triangle}, values, frame.time)
    assert isinstance(frame, GrainFrame)
    points = np.arange(len(frame.radius)).reshape(-1, 1)
    return polydata(frame.position, {"Verts": points}, {"radius": frame.radius, "speed": frame.speed}, frame.time)


def write_kind(folder: pathlib.Path, kind: str, frames: Iterable[Frame]) -> None:
    """The frames of one tire or of the grains, and <kind>.pvd."""
    entries = []
    for frame in frames:
        name = f"{kind}_{frame.index:06d}.vtp"
        (folder / name).write_text(text_of(type(frame)(frame.path, frame.index)))  # a copy, so that no arrays are kept
        entries.append(f'<DataSet timestep="{frame.time:.17g}" file="{name}"/>')
    if entries:
        (folder / f"{kind}.pvd").write_text("\n".join(['<?xml version="1.0"?>',
                                                       '<VTKFile type="Collection" version="0.1">', "<Collection>",
                                                       *entries, "</Collection>", "</VTKFile>", ""]))


def write_kinds(folder: pathlib.Path, kinds: Mapping[str, Iterable[Frame]]) -> pathlib.Path:
    """The frames of {"tire0": …, "terrain": …}."""
    folder.mkdir(parents=True, exist_ok=True)
    for kind, frames in kinds.items():
        write_kind(folder, kind, frames)
    return folder

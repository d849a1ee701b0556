#!/usr/bin/python3
"""Opens a run's results.xdmf: every reference must lead to data of the stated size, and VTK's XDMF reader must find the
points, triangles and finite, varying fields that the HDF5 frames hold.

usage: xdmf_vtk_test.py DIR [--instants N] [--points GRID=N]...

Exit codes: 0 passed, 1 failed, 77 the index is sound, but no VTK with an XDMF reader is installed. Debian 12's
python3-vtk9 is built without that reader; the VTK inside python3-paraview has it.
"""
import argparse
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np

FIELDS = {"tire": ("velocity", "force"), "terrain": ("speed", "radius")}
SKIPPED = 77


def fields_of(name):
    return FIELDS["terrain" if name.startswith("terrain") else "tire"]


def check(ok, what):
    if not ok:
        raise AssertionError(what)


def data_of(item, folder):
    """The array that a DataItem refers to, of the shape that it states."""
    file, _, dataset = item.text.strip().partition(":")
    with h5py.File(folder / file, "r") as opened:
        values = opened[dataset][()]
    stated = tuple(int(n) for n in item.get("Dimensions").split())
    check(values.shape == stated, f"{item.text}: shape {values.shape}, the index states {stated}")
    return values


def read_index(folder):
    """[(time, {grid: {"position", "triangle", fields…}})] by the XDMF standard's rules."""
    root = ElementTree.parse(folder / "results.xdmf").getroot()
    instants = []
    for instant in root.find("Domain/Grid").findall("Grid"):
        grids = {}
        for grid in instant.findall("Grid"):
            topology = grid.find("Topology")
            content = {"position": data_of(grid.find("Geometry/DataItem"), folder)}
            if topology.get("TopologyType") == "Triangle":
                content["triangle"] = data_of(topology.find("DataItem"), folder)
                check(content["triangle"].max() < len(content["position"]), "a triangle has a vertex that is not there")
            for attribute in grid.findall("Attribute"):
                content[attribute.get("Name")] = data_of(attribute.find("DataItem"), folder)
            check(int(topology.get("NumberOfElements")) == len(content.get("triangle", content["position"])),
                  "NumberOfElements does not fit")
            grids[grid.get("Name")] = content
        instants.append((float(instant.find("Time").get("Value")), grids))
    return instants


def check_contents(instants, arguments):
    check(len(instants) >= 2, "fewer than two instants")
    check(arguments.instants in (None, len(instants)), f"{len(instants)} instants, expected {arguments.instants}")
    for expected in arguments.points:
        name, _, count = expected.partition("=")
        for time, grids in instants:
            check(len(grids[name]["position"]) == int(count), f"{name} has {len(grids[name]['position'])} points")
    first, last = instants[0][1], instants[-1][1]
    for name, content in last.items():
        for field in ("position",) + fields_of(name):
            values = [grids[name][field] for _, grids in instants]
            check(all(np.isfinite(v).all() for v in values), f"{name}: {field} is not finite")
            if field != "radius":
                check(any(np.ptp(v) > 0.0 for v in values), f"{name}: {field} is the same everywhere")
        check(not np.array_equal(content["position"], first[name]["position"]), f"{name} never moves")


def xdmf_reader():
    try:
        from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    except ImportError:
        try:
            from vtk import vtkXdmfReader
        except ImportError:
            return None
    return vtkXdmfReader()


def leaves(data):
    """All data sets in nested blocks."""
    if not data.IsA("vtkMultiBlockDataSet"):
        yield data
        return
    for i in range(data.GetNumberOfBlocks()):
        if data.GetBlock(i) is not None:
            yield from leaves(data.GetBlock(i))


def check_with_vtk(reader, folder, instants):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
    reader.SetFileName(str(folder / "results.xdmf"))
    reader.UpdateInformation()
    information = reader.GetOutputInformation(0)
    times = [information.Get(Pipeline.TIME_STEPS(), i) for i in range(information.Length(Pipeline.TIME_STEPS()))]
    check(np.allclose(times, [time for time, _ in instants]), f"VTK finds the times {times}")
    for time, grids in instants:
        reader.UpdateTimeStep(time)
        found = list(leaves(reader.GetOutputDataObject(0)))
        check(len(found) == len(grids), f"VTK finds {len(found)} grids at {time} s, expected {len(grids)}")
        for data in found:
            points = vtk_to_numpy(data.GetPoints().GetData())
            name = next((n for n, g in grids.items() if np.array_equal(points, g["position"])), None)
            check(name is not None, f"VTK finds {len(points)} points at {time} s that are in none of the frames")
            if "triangle" in grids[name]:
                check(data.GetNumberOfCells() == len(grids[name]["triangle"]), f"{data.GetNumberOfCells()} triangles")
            for field in fields_of(name):
                array = data.GetPointData().GetArray(field)
                check(array is not None and np.array_equal(vtk_to_numpy(array), grids[name][field]),
                      f"{name} {field} at {time} s: VTK does not read what the frame holds")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--instants", type=int)
    parser.add_argument("--points", action="append", default=[], metavar="GRID=N")
    arguments = parser.parse_args()
    instants = read_index(arguments.directory)
    check_contents(instants, arguments)
    summary = ", ".join(f"{name} {len(grid['position'])} points" for name, grid in instants[-1][1].items())
    print(f"index: {len(instants)} instants; {summary}")
    reader = xdmf_reader()
    if reader is None:
        print("skipped: no VTK with an XDMF reader (Debian: python3-paraview)")
        return SKIPPED
    check_with_vtk(reader, arguments.directory, instants)
    from vtkmodules.vtkCommonCore import vtkVersion
    print(f"VTK {vtkVersion().GetVTKVersion()} reads the same")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (AssertionError, OSError, KeyError) as failure:
        print(f"failed: {failure}")
        sys.exit(1)

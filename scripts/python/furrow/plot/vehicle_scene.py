"""A picture of a vehicle on its bed: all tires, a sketch of the chassis, ruts coloured by their depth; the camera goes
with the vehicle. Obliquely from behind, cut open beside the right wheels, and from above."""
import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

from . import scene
from .digits import digits
from .ground import median3
from .raster import Buffers, Camera
from .run_data import Damaged, Missing, read_grains

WIDTH, HEIGHT, STRIP = 1500, 800, 400  # pixels: the oblique view; height of those below it, each half as wide
TITLE = 50
BODY, CAB, BEAM = (0.10, 0.16, 0.10), (0.16, 0.22, 0.15), (0.05, 0.05, 0.055)  # linear RGB
HEAPED, SAND, RUT = (0.55, 0.66, 0.78), (0.50, 0.36, 0.22), [(0.70, 0.30, 0.06), (0.55, 0.04, 0.03), (0.16, 0.01, 0.14)]
COLOURS = mpl.colors.LinearSegmentedColormap.from_list("ruts",
                                                       [HEAPED, (0.54, 0.46, 0.40), SAND, RUT[0], RUT[1], RUT[2]])
DARK = (0.16, 0.11, 0.07)
GLOSS = 0.10
LIGHT = scene.LIGHT / np.linalg.norm(scene.LIGHT)
ZERO = 0.4  # where in COLOURS the undisturbed surface is

# Side views of the sketch between rear (0) and front axle (1), heights in tire radii above the wheels' centres.
LOWER = [(-0.20, 0.25), (-0.20, 1.0), (0.62, 1.25), (1.10, 1.05), (1.16, 0.35), (1.08, 0.15)]
UPPER = [(0.10, 1.08), (0.15, 2.3), (0.52, 2.3), (0.68, 1.25)]
DECK = [(-0.12, 0.35), (-0.12, 0.75), (1.08, 0.75), (1.16, 0.55), (1.08, 0.35)]


class Bed:
    """Grains of an instant in the axes of the vehicle: forward, left, up from the place of its origin on the ground."""

    def __init__(self, path, before, origin, yaw, scale):
        position, self.radius = read_grains(path, scale)
        self.cell = 3.0 * self.radius.max()
        depth = self._depth(position, *read_grains(before, scale))
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        self.position = np.column_stack([(position[:, :2] - origin[:2]) @ turn, position[:, 2]])
        ix, iy = self._cells(position)
        self.depth = depth[ix, iy]  # of the ground at each grain's place below what it was, m
        self.below = self.top[ix, iy] - position[:, 2]
        high = position.max(0)
        inset = 2.0 * self.radius.max()
        x0, y0, x1, y1 = *(self.low[:2] + inset), *(high[:2] - inset)
        self.floor_plan = (np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]) - origin[:2]) @ turn
        self.from_wall = np.minimum(position - self.low, high - position)[:, :2].min(1)

    def _cells(self, position):
        return (np.clip(((position[:, k] - self.low[k]) / self.cell).astype(int), 0, self.shape[k] - 1) for k in (0, 1))

    def _tops(self, position, radius):
        top = np.full(self.shape, np.nan)
        ix, iy = self._cells(position)
        np.fmax.at(top, (ix, iy), position[:, 2] + radius)
        return top

    def _depth(self, position, old, old_radius):
        self.low = np.minimum(position.min(0), old.min(0))
        self.shape = tuple(int(n) for n in (np.maximum(position.max(0), old.max(0)) - self.low)[:2] / self.cell + 1)
        if self.shape[0] * self.shape[1] > 10_000_000:
            raise Damaged("the frames of the terrain hold grains that are too far apart to be drawn")
        self.top = self._tops(position, self.radius)
        return median3(self._tops(old, old_radius) - self.top)

    def near(self, ahead, left, cut):
        """Numbers of the grains within these ranges that are worth drawing: near the top, or near faces that are
        cut."""
        x, y = self.position[:, 0], self.position[:, 1]
        inside = (x > ahead[0]) & (x < ahead[1]) & (y > left[0]) & (y < left[1])
        if not inside.any():
            raise Missing("no grains near the vehicle")
        near = 3.0 * self.radius.max()
        edge = (y < left[0] + near) | ((x < ahead[0] + near) & cut) | (self.from_wall < near)
        return np.flatnonzero(inside & (edge | (self.below < 4.0 * self.radius.max())))


def colours(depth, span, number):
    """By depth; slightly different from grain to grain."""
    share = np.where(depth > 0.0, ZERO + (1.0 - ZERO) * depth / span, ZERO * (1.0 + depth / (0.5 * span)))
    speckle = np.random.default_rng(1).normal(1.0, 0.08, number)[:, None]
    return (COLOURS(np.clip(np.nan_to_num(share, nan=ZERO), 0.0, 1.0))[:, :3] * speckle).astype(np.float32)


def prism(outline, half):
    """(vertices, triangles) of a convex side view, as wide as twice `half`; no corners shared, so that edges are
    sharp."""
    n = len(outline)
    right, left = (np.array([(x, side * half, z) for x, z in outline]) for side in (-1.0, 1.0))
    vertex = [*right, *left]
    triangle = [(0, k, k + 1) for k in range(1, n - 1)] + [(n, n + k + 1, n + k) for k in range(1, n - 1)]
    for k in range(n):
        at, j = len(vertex), (k + 1) % n
        vertex += [right[k], left[k], left[j], right[j]]
        triangle += [(at, at + 1, at + 2), (at, at + 2, at + 3)]
    return np.array(vertex), np.array(triangle)


def sketch(v, scale, half_tire):
    """[(vertices, triangles, colour)] of the chassis in the vehicle's frame: its size is taken from the wheels."""
    radius, front, rear = v.wheels[0].radius, v.places[2 * v.order[0]][0], v.places[2 * v.order[-1]][0]
    base = max(front - rear, 2.0 * radius)
    inner = min(abs(left) for _, left in v.places) - half_tire / scale
    height = v.columns["z_m"][0] - np.mean([wheel["axle_height_m"][0] for wheel in v.wheels])
    parts = [(LOWER, 0.95, BODY), (UPPER, 0.85, CAB)] if "engine_speed_rpm" in v and v["engine_speed_rpm"].any() \
        else [(DECK, 0.8, BODY)]
    found = []
    for outline, share, colour in parts:
        points = [(scale * (rear + x * base), scale * (z * radius - height)) for x, z in outline]
        found.append((*prism(points, scale * share * max(inner, 0.3 * radius)), colour))
    return found


def beams(v, tires, scale):
    """Between the wheels of each axle."""
    found, thick = [], 0.07 * scale * v.wheels[0].radius
    for axle in v.order:
        right, left = (0.5 * (tires[2 * axle + k][0].min(0) + tires[2 * axle + k][0].max(0)) for k in (1, 0))
        square = [(-thick, -thick), (-thick, thick), (thick, thick), (thick, -thick)]
        vertex = np.array([end + [x, 0.0, z] for end in (right, left) for x, z in square])
        triangle = [t for k in range(4) for j in [(k + 1) % 4] for t in ((k, 4 + k, 4 + j), (k, 4 + j, j))]
        found.append((vertex, np.array(triangle), BEAM))
    return found


def face_normals(vertex, triangle):
    """Per corner, of corners that flat faces own; outward is not known: towards the outside of the whole."""
    normal = scene.vertex_normals(vertex, triangle)
    flip = ((vertex - vertex.mean(0)) * normal).sum(1) < 0.0
    normal[flip] *= -1.0
    return normal


def add_solid(buffers, vertex, triangle, colour):
    if buffers.depth_only:
        buffers.triangles(vertex, triangle)
        return
    buffers.triangles(vertex, triangle, face_normals(vertex, triangle),
                      np.tile(np.float32(colour), (len(triangle), 1)), GLOSS)


class Stage:
    """What is drawn, in the vehicle's axes, enlarged by `scale`."""

    def __init__(self, v, frame):
        tires, self.time = v.tire_frames(frame)
        self.scale = scene.scale_of(float(np.ptp(tires[0][0][:, 2])))
        origin, rotation = v.pose(self.time)
        yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
        turn = np.array([[np.cos(yaw), np.sin(yaw), 0.0], [-np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
        foot = np.array([origin[0], origin[1], 0.0])
        self.tires = [(self.scale * (vertex - foot) @ turn.T, triangle) for vertex, triangle in tires]
        half_tire = 0.5 * float(np.median([np.ptp(vertex @ scene.spin_axis(vertex)) for vertex, _ in self.tires]))
        self.solids = [(vertex @ (turn @ rotation).T + [0.0, 0.0, self.scale * origin[2]], triangle, colour)
                       for vertex, triangle, colour in sketch(v, self.scale, half_tire)]
        self.solids += beams(v, self.tires, self.scale)
        corners = np.concatenate([vertex for vertex, _ in self.tires])
        self.front, self.back = corners[:, 0].max(), corners[:, 0].min()
        self.size = self.front - self.back
        if not 0.0 < self.size < 1e3 * scene.TIRE_HEIGHT or not np.ptp(corners[:, 1]) < 1e3 * scene.TIRE_HEIGHT:
            raise Damaged("the frames of the tires are too far apart to be drawn")
        self.outside = corners[:, 1].min()  # of the right wheels
        self.half = np.abs(corners[:, 1]).max()
        self.ground = self.scale * v.wheels[0].surface
        self.bed = None
        terrain = v.run.frames("terrain")
        if frame in terrain:
            self.bed = Bed(terrain[frame], terrain[min(terrain)], self.scale * foot, yaw, self.scale)
        self.span = 0.02 * self.scale

    def soil(self, ahead, left, cut=True):
        if self.bed is None:
            return None
        chosen = self.bed.near(ahead, left, cut)
        deepest = np.nanpercentile(self.bed.depth[chosen], 99.5)
        return self.bed.position[chosen], self.bed.radius[chosen], self.bed.depth[chosen], deepest

    def draw(self, buffers, soil):
        if soil is None:
            add_board(buffers, self)
        else:
            add_bottom(buffers, self.bed, soil)
            buffers.spheres(soil[0], soil[1], None if buffers.depth_only else colours(soil[2], self.span, len(soil[1])))
        for vertex, triangle in self.tires:
            scene.add_tire(buffers, vertex, triangle)
        for vertex, triangle, colour in self.solids:
            add_solid(buffers, vertex, triangle, colour)


def clip(polygon, axis, limit, sign):
    """The part of a convex polygon where sign · (coordinate − limit) is not negative."""
    found = []
    for a, b in zip(polygon, np.roll(polygon, -1, 0)):
        inside = sign * (a[axis] - limit) >= 0.0
        if inside:
            found.append(a)
        if inside != (sign * (b[axis] - limit) >= 0.0):
            found.append(a + (b - a) * (limit - a[axis]) / (b[axis] - a[axis]))
    return np.array(found)


def add_bottom(buffers, bed, soil):
    """What shows between the grains, where those below are left out: a dark sheet under them, as far as the bed
    reaches."""
    position, radius = soil[0], float(soil[1].max())
    sheet = bed.floor_plan
    for axis in (0, 1):
        for limit, sign in ((position[:, axis].min() + radius, 1.0), (position[:, axis].max() - radius, -1.0)):
            sheet = clip(sheet, axis, limit, sign) if len(sheet) else sheet
    if len(sheet) < 3:
        return
    z = max(position[:, 2].min(), np.median(position[:, 2]) - np.nanmax(np.append(soil[2], 0.0)) - 3.0 * radius)
    vertex = np.column_stack([sheet, np.full(len(sheet), z)])
    triangle = np.array([(0, k, k + 1) for k in range(1, len(sheet) - 1)])
    if buffers.depth_only:
        buffers.triangles(vertex, triangle)
    else:
        up = np.tile([0.0, 0.0, 1.0], (len(vertex), 1))
        buffers.triangles(vertex, triangle, up, np.tile(np.float32(DARK), (len(triangle), 1)))


def add_board(buffers, stage):
    """Hard ground: squares of half a metre."""
    side = 0.5
    scene.add_squares(buffers, np.arange(stage.back - 0.45 * stage.size, stage.front + 0.3 * stage.size, side),
                      np.arange(-1.6 * stage.half, 1.6 * stage.half, side), side, side, stage.ground)


def picture(stage, soil, camera, light):
    return scene.picture(camera, lambda buffers: stage.draw(buffers, soil), LIGHT, light, 0.004 * stage.size,
                         0.02 * stage.size)


def shadows(stage, soil):
    """What the light sees."""
    target = np.array([0.5 * (stage.front + stage.back), 0.0, stage.ground])
    seen = Buffers(Camera(target + 3.0 * stage.size * LIGHT, target, 1500, 1500, width_m=2.1 * stage.size),
                   depth_only=True)
    stage.draw(seen, soil)
    return seen


def pictures(stage):
    """(obliquely from behind, from the right without the soil in front of the right wheels, from above)."""
    size, half = stage.size, max(1.6 * stage.half, 0.4 * stage.size)
    middle = np.array([0.5 * (stage.front + stage.back) - 0.05 * size, 0.0, stage.ground])
    soil = stage.soil((stage.back - 0.5 * size, stage.front + 0.35 * size), (-half, half))
    if soil is not None:
        stage.span = max(soil[3], 0.5 * float(np.median(soil[1])))
    light = shadows(stage, soil)
    target = middle + [0.0, 0.0, 0.10 * size]
    camera = Camera(target + size * np.array([-1.45, -1.80, 1.15]), target,
                    2 * WIDTH, 2 * HEIGHT, field_of_view=np.radians(32.0))
    oblique = picture(stage, soil, camera, light)
    above = picture(stage, soil, Camera(middle + size * np.array([0.0, -3e-3, 3.0]),
                                        middle, WIDTH, 2 * STRIP, width_m=1.4 * size), light)
    cut = stage.soil((stage.back - 0.3 * size, stage.front + 0.2 * size),
                     (stage.outside, stage.outside + 0.5 * size), cut=False)
    target = middle + [0.0, 0.0, 0.15 * size]
    side = picture(stage, cut, Camera(target - size * np.array([0.0, 3.0, 0.0]),
                                      target, WIDTH, 2 * STRIP, width_m=1.4 * size), None)
    return oblique, side, above


def last_frame(v):
    instants = v.instants()
    terrain = v.run.frames("terrain")
    both = [k for k in instants if k in terrain] if terrain else instants
    if not both:
        raise Missing("no instant has frames of all tires" + (" and the terrain" if terrain else ""))
    return both[-1]


def show(figure, image, left, bottom, width, height, label):
    total = TITLE + HEIGHT + STRIP
    axis = figure.add_axes([left / WIDTH, bottom / total, width / WIDTH, height / total])
    axis.imshow(image, interpolation="none", aspect="auto")
    axis.axis("off")
    axis.text(0.012, 0.965, label, transform=axis.transAxes, va="top", fontsize=10, linespacing=1.4,
              bbox={"facecolor": "white", "alpha": 0.6, "lw": 0, "pad": 2.5})
    return axis


def words(v, stage):
    at = min(int(np.searchsorted(v.time, stage.time)), len(v.time) - 1)
    lines = [f"t = {stage.time:.2f} s", f"speed {digits(v['speed_m_s'][at])} m/s, way {digits(v['distance_m'][at])} m"]
    for axle in v.order:
        depth = [f"{1e3 * wheel['sinkage_m'][at]:.0f}" for wheel in v.of_axle(axle)]
        slip = [f"{wheel['slip'][at]:.2f}" for wheel in v.of_axle(axle)]
        lines.append(f"{v.axles[axle]} axle (left, right): slip {', '.join(slip)}"
                     + ("" if v.hard_ground else f"; sinkage {', '.join(depth)} mm"))
    if v.run.number("grains"):
        lines.append(f"{v.run.number('grains'):,.0f} grains")
    return "\n".join(lines)


def vehicle_scene(v):
    """The last instant of which there are all frames."""
    stage = Stage(v, last_frame(v))
    total = TITLE + HEIGHT + STRIP
    figure = plt.figure(figsize=(WIDTH / 130, total / 130), layout="none")
    figure.text(0.015, 1 - 0.5 * TITLE / total, v.title, fontsize=12, fontweight="bold", va="center")
    oblique, side, above = pictures(stage)
    show(figure, oblique, 0, STRIP, WIDTH, HEIGHT, words(v, stage))
    show(figure, side, 0, 0, WIDTH // 2, STRIP, "from the right"
         + ("" if stage.bed is None else ", cut beside the right wheels"))
    axis = show(figure, above, WIDTH // 2, 0, WIDTH // 2, STRIP, "from above")
    axis.annotate("travel", (0.97, 0.93), (0.82, 0.93), xycoords="axes fraction",
                  va="center", arrowprops={"arrowstyle": "-|>"}, fontsize=9,
                  bbox={"facecolor": "white", "alpha": 0.6, "lw": 0, "pad": 2.0})
    if stage.bed is not None:
        scale_of_depth(figure, stage)
    return figure


def scale_of_depth(figure, stage):
    total = TITLE + HEIGHT + STRIP
    bar = figure.add_axes([0.72, (STRIP + 60) / total, 0.25, 14 / total])
    span = 1e3 * stage.span / stage.scale
    shown = mpl.colors.LinearSegmentedColormap.from_list("shown",
                                                         COLOURS(np.linspace(0.0, 1.0, 64))[:, :3] ** (1 / 2.2))
    bar.imshow(np.linspace(0.0, 1.0, 256)[None], cmap=shown, aspect="auto", extent=(0.0, 1.0, 0.0, 1.0))
    ticks = [-0.5 * span, 0.0, 0.25 * span, 0.5 * span, 0.75 * span, span]
    bar.set_xticks([ZERO + (1 - ZERO) * t / span if t > 0 else ZERO * (1 + t / (0.5 * span)) for t in ticks],
                   [digits(t) for t in ticks])
    bar.set_yticks([])
    bar.grid(False)
    bar.tick_params(labelsize=8)
    bar.set_xlabel("depth below the undisturbed surface, mm", fontsize=9)

"""A picture of the tire on the bed with its rut, from the last frames of a run."""
import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

from .digits import digits, with_error
from .raster import Buffers, Camera, occlusion, shade, shadow
from .run_data import Missing, read_grains, read_surface

WIDTH, HEIGHT = 1500, 860  # pixels of the picture; rendered at twice that
GAMMA = 2.2
BEHIND, AHEAD = 1.45, 0.75  # m of the bed that are shown, from the axle of a tire as high as this one:
TIRE_HEIGHT = 0.935  # m; scenes of other sizes are drawn at another scale
LIGHT = np.array([0.35, -0.55, 0.76])  # towards the light, for travel along +x
SOIL = [(0.23, 0.12, 0.05), (0.55, 0.36, 0.19), (0.86, 0.72, 0.50)]  # linear RGB: low, undisturbed, high
RUBBER, RIM = np.array([0.075, 0.077, 0.083]), np.array([0.30, 0.31, 0.33])


def last_frames(run):
    """(tire, terrain or None) files of the last instant at which both exist."""
    tires, grains = run.frames("tire0"), run.frames("terrain")
    both = sorted(set(tires) & set(grains)) if grains else sorted(tires)
    if not both:
        raise Missing("there are no frames of tire 0" if not tires else "no instant has frames of tire and terrain")
    return tires[both[-1]], grains.get(both[-1])


def vertex_normals(vertex, triangle):
    corner = vertex[triangle]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    total = np.zeros_like(vertex)
    for i in range(3):
        np.add.at(total, triangle[:, i], normal)
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12)


def outline(vertex, triangle):
    """Sides that are drawn: all but the longest, which is the diagonal of the facet."""
    corner = vertex[triangle]
    length = np.linalg.norm(np.roll(corner, -1, 1) - np.roll(corner, -2, 1), axis=2)
    return length < length.max(1, keepdims=True) * (1.0 - 1e-9)


class Soil:
    """The grains worth drawing: near the top or near the cuts that face the camera."""

    def __init__(self, path, centre, sign, scale):
        position, radius = read_grains(path, scale)
        self.lateral = (position[:, 1].min(), position[:, 1].max())
        ahead = sign * (position[:, 0] - centre[0])
        inside = (ahead > -BEHIND) & (ahead < AHEAD)
        position, radius, ahead = position[inside], radius[inside], ahead[inside]
        if len(radius) == 0:
            raise Missing("no grains near the tire")
        cell = 3.0 * radius.max()
        ix = ((position[:, 0] - position[:, 0].min()) / cell).astype(int)
        iy = ((position[:, 1] - position[:, 1].min()) / cell).astype(int)
        top = np.full((ix.max() + 1, iy.max() + 1), -np.inf)
        np.maximum.at(top, (ix, iy), position[:, 2])
        near = np.maximum(1.5 * radius.max(), 0.01)
        cut = (ahead < -BEHIND + 2 * near) | (position[:, 1] < position[:, 1].min() + 2 * near)
        shown = cut | (position[:, 2] > top[ix, iy] - 6.0 * radius.max())
        self.position, self.radius = position[shown], radius[shown]
        self.surface = float(np.median(top[np.isfinite(top)])) + float(np.median(radius))


def soil_colours(soil, surface, span):
    """Colour by height about the undisturbed surface, slightly different from grain to grain."""
    share = np.clip(0.5 + 0.5 * (soil.position[:, 2] + soil.radius - surface) / span, 0.0, 1.0)
    map_ = mpl.colors.LinearSegmentedColormap.from_list("soil", SOIL)
    speckle = np.random.default_rng(1).normal(1.0, 0.10, (len(share), 1))
    return (map_(share)[:, :3] * speckle).astype(np.float32)


def spin_axis(vertex):
    """Of a tire: the direction nearest to the left in which it is thinnest or symmetric."""
    _, vectors = np.linalg.eigh(np.cov((vertex - vertex.mean(0)).T))
    return vectors[:, int(np.argmax(np.abs(vectors[1])))]


def add_tire(buffers, vertex, triangle):
    """Also of a wheel that is steered or leans."""
    if buffers.depth_only:
        buffers.triangles(vertex, triangle)
        return
    middle, axis = vertex[triangle].mean(1) - 0.5 * (vertex.min(0) + vertex.max(0)), spin_axis(vertex)
    distance = np.linalg.norm(middle - (middle @ axis)[:, None] * axis, axis=1)
    rim = distance < 0.52 * distance.max()
    colour = np.where(rim[:, None], RIM, RUBBER).astype(np.float32)
    edge = outline(vertex, triangle) & ~rim[:, None]
    buffers.triangles(vertex, triangle, vertex_normals(vertex, triangle), colour, 0.16, edge)


def add_squares(buffers, x, y, across, side, z):
    """Rigid ground: squares of two greys, `across` along x and `side` along y from each x and y."""
    vertex, triangle, colour = [], [], []
    for i, a in enumerate(x):
        for j, b in enumerate(y):
            n = len(vertex)
            vertex += [(a, b, z), (a + across, b, z), (a + across, b + side, z), (a, b + side, z)]
            triangle += [(n, n + 1, n + 2), (n, n + 2, n + 3)]
            colour += 2 * [(0.42, 0.43, 0.45) if (i + j) % 2 else (0.55, 0.56, 0.58)]
    vertex, triangle = np.array(vertex), np.array(triangle)
    if buffers.depth_only:
        buffers.triangles(vertex, triangle)
    else:
        up = np.tile([0.0, 0.0, 1.0], (len(vertex), 1))
        buffers.triangles(vertex, triangle, up, np.array(colour, np.float32))


def draw(buffers, tire, soil, colours, centre, sign, ground):
    if soil is not None:
        buffers.spheres(soil.position, soil.radius, colours)
    else:
        add_squares(buffers, centre[0] + sign * np.arange(-BEHIND, AHEAD, 0.1),
                    np.arange(-0.4, 0.4, 0.1), sign * 0.1, 0.1, ground)
    add_tire(buffers, *tire)


def render(tire, soil, colours, centre, sign, ground):
    """(picture, its camera)."""
    size = np.ptp(tire[0][:, 2])
    along = np.array([sign, 0.0, 0.0])
    target = np.array([centre[0], 0.0, ground]) - 0.30 * along + [0.0, 0.0, 0.26 * size]
    eye = target - 3.5 * along + [0.0, -4.5, 2.9]
    camera = Camera(eye, target, 2 * WIDTH, 2 * HEIGHT, field_of_view=np.radians(24.5))
    light = LIGHT * [sign, 1.0, 1.0] / np.linalg.norm(LIGHT)
    from_light = Buffers(Camera(target + 5.0 * light, target, 1500, 1500, width_m=3.2), depth_only=True)
    draw(from_light, tire, soil, None, centre, sign, ground)
    image = picture(camera, lambda buffers: draw(buffers, tire, soil, colours, centre, sign, ground), light, from_light,
                    0.006, 0.05)
    return image, camera


def picture(camera, draw_in, light, from_light, bias, depth):
    """sRGB pixels, of 8 bits, at half the camera's resolution. `light` points to the light, which sees `from_light`,
    None: all; `bias` of its shadows and `depth` of the occlusion, m."""
    buffers = Buffers(camera)
    draw_in(buffers)
    lit = 1.0 if from_light is None else shadow(buffers, from_light, bias=bias)
    row = np.linspace(0.0, 1.0, camera.height)[:, None, None]
    background = np.broadcast_to(((1 - row) * [0.80, 0.86, 0.92] + row * [0.97, 0.97, 0.96]) ** GAMMA,
                                 (camera.height, camera.width, 3))
    image = shade(buffers, light, lit, occlusion(buffers, (3, 8, 20), depth), background)
    image = image[::2, ::2] + image[1::2, ::2] + image[::2, 1::2] + image[1::2, 1::2]
    return np.uint8(255.0 * (0.25 * image) ** np.float32(1.0 / GAMMA) + 0.5)


def scale_of(height):
    """By which a scene is enlarged so that a tire of this height fits the picture; 1 where it does anyway."""
    return 1.0 if 0.5 < height / TIRE_HEIGHT < 2.0 else TIRE_HEIGHT / height


def annotate(axis, run, time, camera, centre, sign, ground, scale):
    def at(point):
        column, row, _, _ = camera.project(np.array([point]))
        return column[0] / 2, row[0] / 2

    edge, below = -0.5, ground - 0.10
    start, end = (at((centre[0] + sign * a, edge, below)) for a in (0.10, 0.60))
    axis.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "lw": 2.5, "color": "#333333"})
    axis.annotate("travel", start, xytext=(4, -16), textcoords="offset points", ha="left", fontsize=11)
    bar = float(f"{0.5 / scale:.1g}")  # m
    left, right = (at((centre[0] + sign * a, edge, below)) for a in (-0.85, -0.85 + bar * scale))
    axis.plot([left[0], right[0]], [left[1], right[1]], color="#333333", lw=3, solid_capstyle="butt")
    axis.annotate(f"{bar:g} m", left, xytext=(6, -12), textcoords="offset points", ha="left", fontsize=11)
    lines = [f"t = {time:.2f} s"]
    pull = run.summary.get("drawbar_pull_N") or {}
    if not run.measured:
        lines.append("the tire did not touch the terrain: nothing measured")
    elif pull.get("mean") is not None:
        lines.append(f"drawbar pull {with_error(pull['mean'], pull.get('sem'))} N"
                     + ("" if pull.get("steady") else " (not steady)"))
    for name, label in (("sinkage_m", "sinkage"), ("rut_depth_m", "rut depth")):
        if run.number(name) is not None:
            lines.append(f"{label} {digits(1e3 * run.number(name))} mm")
    if run.number("grains"):
        lines.append(f"{run.number('grains'):,.0f} grains")
    axis.text(0.015, 0.97, "\n".join(lines), transform=axis.transAxes, va="top", fontsize=11.5, linespacing=1.5)


def scene(run):
    """The tire on the bed in the last frame."""
    tire_file, grain_file = last_frames(run)
    vertex, triangle, time = read_surface(tire_file)
    scale = scale_of(float(np.ptp(vertex[:, 2])))
    tire = scale * vertex, triangle
    centre, sign = 0.5 * (tire[0].min(0) + tire[0].max(0)), run.travel_sign
    soil = colours = None
    ground, span = scale * run.number("surface_height_m", 0.0), 1e-3
    if grain_file is not None:
        soil = Soil(grain_file, centre, sign, scale)
        ground = scale * run.number("surface_height_m", soil.surface / scale)
        depth = np.percentile(ground - soil.position[:, 2] - soil.radius, 98)
        span = max(1.6 * scale * run.number("rut_depth_m", 0.0), 0.15 * depth, 2.0 * np.median(soil.radius))
        colours = soil_colours(soil, ground, span)
    image, camera = render(tire, soil, colours, centre, sign, ground)
    figure = plt.figure(figsize=(WIDTH / 130, (HEIGHT + 60) / 130), layout="none")
    axis = figure.add_axes([0, 0, 1, HEIGHT / (HEIGHT + 60)])
    axis.imshow(image, interpolation="none", aspect="auto", extent=(0, WIDTH, HEIGHT, 0))
    axis.set(xlim=(0, WIDTH), ylim=(HEIGHT, 0))
    axis.axis("off")
    figure.text(0.015, 1 - 30 / (HEIGHT + 60), run.title, fontsize=12, fontweight="bold", va="center")
    annotate(axis, run, time, camera, centre, sign, ground, scale)
    if soil is not None:
        bar = figure.add_axes([0.72, 0.075, 0.25, 0.018])
        map_ = mpl.colors.LinearSegmentedColormap.from_list("soil", np.array(SOIL) ** (1 / GAMMA))
        colourbar = figure.colorbar(mpl.cm.ScalarMappable(mpl.colors.Normalize(-1e3 * span / scale, 1e3 * span / scale),
                                                          map_), cax=bar, orientation="horizontal")
        colourbar.set_label("height of grains about the undisturbed surface, mm", fontsize=9)
        colourbar.ax.tick_params(labelsize=8)
    return figure

"""A small z-buffered renderer of spheres and triangles in numpy.

Fragments (pixel, depth, normal, colour) are kept per pixel for the nearest surface only; light, shadow and ambient
occlusion are added to the finished buffers, so that the cost grows with pixels and not with grains.
"""
import numpy as np

CHUNK = 1_500_000  # fragments at a time
LARGEST_STAMP = 256  # pixels: triangles beyond it are drawn one by one


class Camera:
    """Perspective camera; depth is measured along its axis, m. With `width_m` given it is orthographic."""

    def __init__(self, eye, target, width, height, field_of_view=None, width_m=None):
        self.eye = np.asarray(eye, float)
        forward = np.asarray(target, float) - self.eye
        self.forward = forward / np.linalg.norm(forward)
        right = np.cross(self.forward, [0.0, 0.0, 1.0])
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.forward)
        self.width, self.height = width, height
        self.perspective = width_m is None
        self.scale = 0.5 * width / np.tan(0.5 * field_of_view) if self.perspective else width / width_m

    def project(self, points):
        """Pixel coordinates (column, row), depth, and pixels per metre there."""
        relative = np.asarray(points, float) - self.eye
        depth = relative @ self.forward
        scale = self.scale / np.maximum(depth, 1e-6) if self.perspective else np.full(len(depth), self.scale)
        return (0.5 * self.width + scale * (relative @ self.right),
                0.5 * self.height - scale * (relative @ self.up), depth, scale)

    def world(self, column, row, depth):
        """The points that project() takes to (column, row, depth)."""
        scale = self.scale / depth if self.perspective else self.scale
        x, y = (column - 0.5 * self.width) / scale, (0.5 * self.height - row) / scale
        return (self.eye + depth[:, None] * self.forward + x[:, None] * self.right + y[:, None] * self.up)


class Buffers:
    """What is seen in each pixel: depth (m, inf: nothing), normal (world), colour (linear RGB), gloss."""

    def __init__(self, camera, depth_only=False):
        self.camera = camera
        pixels = camera.width * camera.height
        self.depth = np.full(pixels, np.inf, np.float32)
        self.depth_only = depth_only
        if not depth_only:
            self.normal = np.zeros((pixels, 3), np.float32)
            self.colour = np.zeros((pixels, 3), np.float32)
            self.gloss = np.zeros(pixels, np.float32)

    def put(self, pixel, depth, normal=None, colour=None, gloss=0.0):
        """Fragments with columns in common; the nearest of each pixel stays."""
        depth = depth.astype(np.float32)
        nearer = depth < self.depth[pixel]
        order = np.flatnonzero(nearer)
        # of equal pixels the last assignment, the nearest, stays
        order = order[np.argsort(-depth[order], kind="stable")]
        pixel = pixel[order]
        self.depth[pixel] = depth[order]
        if self.depth_only:
            return
        self.normal[pixel] = normal[order]
        self.colour[pixel] = colour[order]
        self.gloss[pixel] = gloss

    def spheres(self, centre, radius, colour=None):
        camera = self.camera
        column, row, depth, scale = camera.project(centre)
        reach = np.ceil(radius * scale + 0.5).astype(int)
        seen = ((depth > 0.0) & (column > -reach) & (column < camera.width + reach) & (row > -reach)
                & (row < camera.height + reach))
        for size in np.unique(reach[seen]):
            members = np.flatnonzero(seen & (reach == size))
            stamp = np.mgrid[-size:size + 1, -size:size + 1].reshape(2, -1)
            step = max(1, CHUNK // stamp.shape[1])
            for first in range(0, len(members), step):
                chosen = members[first:first + step]
                self._stamp(chosen, stamp, column, row, depth, scale, radius, colour)

    def _stamp(self, chosen, stamp, column, row, depth, scale, radius, colour):
        camera = self.camera
        px = np.floor(column[chosen]).astype(int)[:, None] + stamp[1]
        py = np.floor(row[chosen]).astype(int)[:, None] + stamp[0]
        in_pixels = (radius[chosen] * scale[chosen])[:, None]
        u = (px + 0.5 - column[chosen][:, None]) / in_pixels
        v = (row[chosen][:, None] - py - 0.5) / in_pixels
        inside = (u * u + v * v < 1.0) & (px >= 0) & (px < camera.width) & (py >= 0) & (py < camera.height)
        which, _ = np.nonzero(inside)
        u, v = u[inside], v[inside]
        w = np.sqrt(1.0 - u * u - v * v)
        grain = chosen[which]
        surface = depth[grain] - radius[grain] * w
        pixel = py[inside] * camera.width + px[inside]
        if self.depth_only:
            self.put(pixel, surface)
            return
        normal = (u[:, None] * camera.right + v[:, None] * camera.up - w[:, None] * camera.forward).astype(np.float32)
        self.put(pixel, surface, normal, colour[grain])

    def triangles(self, vertex, index, normal=None, colour=None, gloss=0.0, edge=None):
        """`normal` per vertex, `colour` per triangle; `edge`: (n, 3) which sides, opposite to each corner, are
        drawn."""
        column, row, depth, _ = self.camera.project(vertex)
        x, y, z = column[index], row[index], depth[index]
        area = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
        size = np.maximum(np.ptp(x, 1), np.ptp(y, 1)) + 2.0
        seen = ((z > 0.0).all(1) & (np.abs(area) > 1e-9) & (x.max(1) >= 0.0) & (x.min(1) < self.camera.width)
                & (y.max(1) >= 0.0) & (y.min(1) < self.camera.height))
        side = 4
        while seen.any():
            members = np.flatnonzero(seen & (size <= side)) if side < LARGEST_STAMP else np.flatnonzero(seen)
            step = max(1, CHUNK // (4 * side * side))
            for first in range(0, len(members), step):
                chosen = members[first:first + step]
                covered = self._covered(x[chosen], y[chosen], side)
                if covered is not None:
                    self._fill(chosen, covered, index, z, normal, colour, gloss, edge)
            seen[members] = False
            side *= 2

    def _fill(self, chosen, covered, index, z, normal, colour, gloss, edge):
        """Fragments of triangles: which of `chosen` they belong to, where they are, and their weights."""
        which, px, py, weight, sharp = covered
        corners = z[chosen][which]
        depth = 1.0 / (weight / corners).sum(1) if self.camera.perspective else (weight * corners).sum(1)
        pixel = py * self.camera.width + px
        if self.depth_only:
            self.put(pixel, depth)
            return
        shade = colour[chosen][which]
        if edge is not None:
            line = ((weight / sharp[which] < 0.8) & edge[chosen][which]).any(1)
            shade[line] *= 0.45
        self.put(pixel, depth, np.einsum("ij,ijk->ik", weight, normal[index[chosen]][which]).astype(np.float32),
                 shade, gloss)

    def _covered(self, x, y, side):
        """(triangle, column, row) of the pixels of triangles within squares of `side` pixels or, of larger ones, within
        all that is seen of them; barycentric weights, and per triangle the weights' change per pixel. None: there are
        none."""
        camera = self.camera
        left, above = (np.maximum(np.floor(v.min(1)), 0.0).astype(int) for v in (x, y))
        wide, high = side, side
        if side >= LARGEST_STAMP:
            wide = int(np.max(np.minimum(x.max(1) + 1.0, camera.width) - left)) + 1
            high = int(np.max(np.minimum(y.max(1) + 1.0, camera.height) - above)) + 1
        area = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
        dx, dy = np.roll(x, -2, 1) - np.roll(x, -1, 1), np.roll(y, -2, 1) - np.roll(y, -1, 1)
        x1, y1 = np.roll(x, -1, 1), np.roll(y, -1, 1)
        # A weight is linear in the pixel: the difference of a part of its row and a part of its column.
        by_row = ((above[:, None] + 0.5 - y1)[:, :, None] + np.arange(high)) * (dx / area[:, None])[:, :, None]
        by_column = ((left[:, None] + 0.5 - x1)[:, :, None] + np.arange(wide)) * (dy / area[:, None])[:, :, None]
        inside = by_row[:, 0, :, None] >= by_column[:, 0, None]
        for k in (1, 2):
            inside &= by_row[:, k, :, None] >= by_column[:, k, None]
        which, down, across = np.nonzero(inside)
        px, py = left[which] + across, above[which] + down
        on_picture = (px < camera.width) & (py < camera.height)
        if not on_picture.any():
            return None
        which, down, across = which[on_picture], down[on_picture], across[on_picture]
        return (which, px[on_picture], py[on_picture], by_row[which, :, down] - by_column[which, :, across],
                np.hypot(dx, dy) / np.abs(area[:, None]))


def box_blur(image, half):
    """Mean over a square of 2 half + 1 pixels, edges repeated."""
    for axis in (0, 1):
        padded = np.pad(image, [(half + 1, half) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
        total, n = np.cumsum(padded, axis, float).swapaxes(0, axis), image.shape[axis]
        image = ((total[2 * half + 1:] - total[:n]) / (2 * half + 1)).swapaxes(0, axis)
    return image


def occlusion(buffers, sizes, depth_scale):
    """How much of the sky is hidden by what is in front nearby, 0…1, from the depth buffer alone. Computed at half the
    resolution, for `sizes` in pixels of that."""
    camera = buffers.camera
    depth = buffers.depth.reshape(camera.height, camera.width)[::2, ::2]
    far = np.isfinite(depth)
    filled = np.where(far, depth, depth[far].max() if far.any() else 1.0)
    hidden = np.zeros_like(filled)
    for half in sizes:
        hidden += np.clip((filled - box_blur(filled, half)) / depth_scale, 0.0, 1.0) / len(sizes)
    return hidden.repeat(2, 0).repeat(2, 1).ravel()


def shadow(buffers, light_buffers, bias):
    """Share of light, 0…1, by a shadow map with 3 × 3 samples."""
    camera, light = buffers.camera, light_buffers.camera
    pixel = np.flatnonzero(np.isfinite(buffers.depth))
    point = camera.world(pixel % camera.width + 0.5, pixel // camera.width + 0.5, buffers.depth[pixel])
    column, row, depth, _ = light.project(point)
    lit = np.zeros(len(pixel), np.float32)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            x = np.clip(column.astype(int) + dx, 0, light.width - 1)
            y = np.clip(row.astype(int) + dy, 0, light.height - 1)
            lit += (depth <= light_buffers.depth[y * light.width + x] + bias) / 9.0
    result = np.ones(len(buffers.depth), np.float32)
    result[pixel] = lit
    return result


def shade(buffers, light_direction, light_share, hidden, background):
    """The picture, (height, width, 3) linear RGB 0…1. `light_direction` points to the light."""
    camera = buffers.camera
    seen = np.flatnonzero(np.isfinite(buffers.depth))
    normal = buffers.normal[seen]
    normal /= np.maximum(np.sqrt(np.einsum("ij,ij->i", normal, normal)), np.float32(1e-9))[:, None]
    light_share = np.broadcast_to(np.float32(light_share), len(buffers.depth))[seen]
    lambert = np.clip(normal @ light_direction.astype(np.float32), 0.0, 1.0) * light_share
    sky = 0.5 + 0.5 * normal[:, 2]
    ambient = (0.20 + 0.30 * sky) * (1.0 - 0.85 * hidden[seen])
    half = light_direction - camera.forward
    half = (half / np.linalg.norm(half)).astype(np.float32)
    specular = buffers.gloss[seen] * np.clip(normal @ half, 0.0, 1.0) ** 30 * light_share
    image = background.reshape(-1, 3).astype(np.float32)
    image[seen] = np.clip(buffers.colour[seen] * (ambient + 0.85 * lambert)[:, None] + specular[:, None], 0.0, 1.0)
    return image.reshape(camera.height, camera.width, 3)

// Tires, the surface of the bed, hard ground, and the schematic body of a vehicle.
import {
  BufferAttribute,
  BufferGeometry,
  BoxGeometry,
  DoubleSide,
  EdgesGeometry,
  Euler,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
} from "three";
import { colour } from "./colours.js";
import { tirePositions } from "./unpack.js";

const RGB = [0, 0, 0];

export function paint(attribute, count, map, share) {
  const out = attribute.array;
  for (let i = 0; i < count; i++) {
    colour(map, share(i), RGB);
    for (let c = 0; c < 3; c++) out[3 * i + c] = (RGB[c] / 255) ** 2.2;
  }
  attribute.needsUpdate = true;
}

/** The surface of one tire; `area` belongs to each vertex, m². */
export class Tire {
  constructor(description, arrays) {
    this.description = description;
    this.reference = arrays.get(description.reference);
    const triangles = Uint32Array.from(arrays.get(description.triangles));
    this.geometry = new BufferGeometry();
    this.position = new BufferAttribute(Float32Array.from(this.reference), 3);
    this.colour = new BufferAttribute(new Float32Array(3 * description.vertices), 3);
    this.geometry.setAttribute("position", this.position);
    this.geometry.setAttribute("color", this.colour);
    this.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.mesh = new Mesh(this.geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
    this.mesh.frustumCulled = false;
    this.area = areas(this.reference, triangles);
    this.centre = [0, 0, 0];
    this.rim = rimOf(this.reference);
    this.sector = sectorOf(this.reference);
    this.radius = (Math.max(...everyThird(this.reference, 2)) - Math.min(...everyThird(this.reference, 2))) / 2;
  }

  show(pose, frame) {
    tirePositions(this.description, this.reference, pose, frame.deviation, this.position.array);
    this.position.needsUpdate = true;
    this.geometry.computeVertexNormals();
    for (let c = 0; c < 3; c++) {
      let sum = 0;
      for (let i = c; i < this.position.array.length; i += 3) sum += this.position.array[i];
      this.centre[c] = sum / this.description.vertices;
    }
  }
}

const everyThird = (values, first) => values.filter((_, i) => i % 3 === first);

function areas(position, triangles) {
  const area = new Float32Array(position.length / 3);
  const edge = (a, b, c) => position[3 * a + c] - position[3 * b + c];
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.subarray(t, t + 3);
    const u = [0, 1, 2].map((k) => edge(b, a, k)),
      v = [0, 1, 2].map((k) => edge(c, a, k));
    const size = Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 6;
    for (const k of [a, b, c]) area[k] += size;
  }
  return area;
}

/** Which vertices belong to the rim: the inner half of the radius. */
function rimOf(position) {
  const x = everyThird(position, 0),
    z = everyThird(position, 2);
  const mid = (values) => (Math.max(...values) + Math.min(...values)) / 2;
  const cx = mid(x),
    cz = mid(z);
  const distance = x.map((v, i) => Math.hypot(v - cx, z[i] - cz));
  const most = Math.max(...distance);
  return distance.map((d) => (d < 0.56 * most ? 1 : 0));
}

/** Twelfths of the tread by turns, so that one sees the wheel roll. */
function sectorOf(position) {
  const x = everyThird(position, 0),
    z = everyThird(position, 2);
  const mid = (values) => (Math.max(...values) + Math.min(...values)) / 2;
  const cx = mid(x),
    cz = mid(z);
  const distance = x.map((v, i) => Math.hypot(v - cx, z[i] - cz)),
    most = Math.max(...distance);
  return x.map((v, i) =>
    distance[i] > 0.9 * most && Math.floor((Math.atan2(z[i] - cz, v - cx) / Math.PI) * 6 + 6) % 2 ? 1 : 0,
  );
}

/** The surface of the bed over its grid. */
export class Surface {
  constructor(bed) {
    this.bed = bed;
    this.position = new BufferAttribute(new Float32Array(3 * bed.nx * bed.ny), 3);
    this.colour = new BufferAttribute(new Float32Array(3 * bed.nx * bed.ny), 3);
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute("position", this.position);
    this.geometry.setAttribute("color", this.colour);
    this.mesh = new Mesh(this.geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
    this.mesh.frustumCulled = false;
    this.cells = [];
    for (let i = 0; i + 1 < bed.nx; i++) for (let j = 0; j + 1 < bed.ny; j++) this.cells.push(i * bed.ny + j);
  }

  height(value) {
    return value === -32768 ? NaN : this.bed.low[2] + (value + 32767) * this.bed.scale[2];
  }

  show(frame, drop) {
    const { nx, ny, low, cell } = this.bed,
      out = this.position.array,
      index = [];
    for (let i = 0; i < nx; i++)
      for (let j = 0; j < ny; j++) {
        const k = i * ny + j,
          z = this.height(frame[k]);
        out[3 * k] = low[0] + (i + 0.5) * cell;
        out[3 * k + 1] = low[1] + (j + 0.5) * cell;
        out[3 * k + 2] = Number.isNaN(z) ? low[2] : z - drop;
      }
    for (const k of this.cells) {
      if ([k, k + 1, k + ny, k + ny + 1].some((n) => frame[n] === -32768)) continue;
      index.push(k, k + ny, k + 1, k + 1, k + ny, k + ny + 1);
    }
    this.position.needsUpdate = true;
    this.geometry.setIndex(index);
    this.geometry.computeVertexNormals();
  }
}

const MOST_LINES = 120; // of a grid, in each direction

/** Height of a profile [[x, z], …] at x: straight between the entries, level outside; at an upright face the upper
 * end. */
function heightAt(profile, x) {
  const next = profile.findIndex(([at]) => at > x);
  if (next < 0) return profile.at(-1)[1];
  if (next === 0) return profile[0][1];
  const [[a, low], [b, high]] = profile.slice(next - 1, next + 1);
  return low + ((high - low) * (x - a)) / (b - a);
}

/** Hard ground as a grid around the path of the wheels, with the upright faces of its profile; without a profile at
 * one height. */
export function hardGround(level, profile, from, to, radius) {
  const reach = 3 * radius,
    [x0, x1] = [from[0] - reach, to[0] + reach],
    [y0, y1] = [from[1] - reach, to[1] + reach];
  let step = 10 ** Math.round(Math.log10(radius / 4));
  while (Math.max(x1 - x0, y1 - y0) / step > MOST_LINES) step *= 2;
  const height = (x) => (profile.length ? heightAt(profile, x) : level);
  const along = [{ x: x0, z: height(x0) }]; // the profile from end to end: its own points, and one at each line across
  const inside = profile.filter(([x]) => x > x0 && x < x1).map(([x, z]) => ({ x, z }));
  for (let x = Math.ceil(x0 / step) * step; x < x1; x += step) inside.push({ x, z: height(x) });
  along.push(...inside.sort((a, b) => a.x - b.x), { x: x1, z: height(x1) });
  const points = [];
  for (const { x, z } of along) points.push(x, y0, z, x, y1, z);
  for (let y = y0; y <= y1 + 1e-9; y += step)
    for (let k = 0; k + 1 < along.length; k++)
      points.push(along[k].x, y, along[k].z, along[k + 1].x, y, along[k + 1].z);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(points), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: 0x8a8f96 }));
}

/** A schematic body: a box between the wheels, in the frame of the chassis. The model's chassis has no shape. */
export function body(wheels, radius, pose) {
  const group = new Group();
  const inverse = (point) => local(point, pose);
  const places = wheels.map(inverse);
  const range = (k) => [Math.min(...places.map((p) => p[k])), Math.max(...places.map((p) => p[k]))];
  const [x0, x1] = range(0),
    [y0, y1] = range(1),
    z = places.reduce((sum, p) => sum + p[2], 0) / places.length;
  const material = new MeshLambertMaterial({ color: 0x6d8299, transparent: true, opacity: 0.55 });
  const lines = new LineBasicMaterial({ color: 0x2b3a4a });
  const width = Math.max(y1 - y0 - 1.1 * radius, 0.4 * (y1 - y0), 0.5 * radius);
  const add = (lx, ly, lz, cx, cz) => {
    const box = new Mesh(new BoxGeometry(lx, ly, lz), material);
    box.position.set(cx, (y0 + y1) / 2, cz);
    const edges = new LineSegments(new EdgesGeometry(box.geometry), lines);
    edges.position.copy(box.position);
    group.add(box, edges);
  };
  const length = x1 - x0 + 1.3 * radius;
  add(length, width, 0.7 * radius, (x0 + x1) / 2, z + 0.55 * radius);
  add(0.45 * length, 0.9 * width, 0.7 * radius, (x0 + x1) / 2 - 0.05 * length, z + 1.25 * radius);
  const axles = new BufferGeometry();
  axles.setAttribute(
    "position",
    new BufferAttribute(
      Float32Array.from(
        places.flatMap(([x, y, h]) => [
          x,
          y,
          h,
          x,
          (y0 + y1) / 2 + Math.sign(y - (y0 + y1) / 2) * width * 0.3,
          z + 0.25 * radius,
        ]),
      ),
      3,
    ),
  );
  group.add(new LineSegments(axles, lines));
  return group;
}

export const euler = (pose) => new Euler(pose[3], pose[4], pose[5], "ZYX");

function local(point, pose) {
  const [cr, sr, cp, sp, cy, sy] = [3, 4, 5].flatMap((k) => [Math.cos(pose[k]), Math.sin(pose[k])]);
  const d = [0, 1, 2].map((k) => point[k] - pose[k]);
  const turn = [
    [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
    [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
    [-sp, cp * sr, cp * cr],
  ];
  return [0, 1, 2].map((c) => turn[0][c] * d[0] + turn[1][c] * d[1] + turn[2][c] * d[2]);
}

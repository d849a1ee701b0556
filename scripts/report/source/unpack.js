// The frames that page/frames.py packed: positions of tires and grains, and the surface of the bed.
import { bytes } from "./data.js";

/** Reads 16-bit numbers whose low bytes come first, then their high bytes. */
class Planes {
  constructor(data) {
    this.data = data;
    this.at = 0;
  }

  words(count, out, add) {
    const { data, at } = this;
    for (let i = 0; i < count; i++) {
      const value = data[at + i] | (data[at + count + i] << 8);
      out[i] = add ? add[i] + value : value; // out wraps around at 2¹⁶, as the differences do
    }
    this.at += 2 * count;
  }

  bytes(count) {
    const found = this.data.subarray(this.at, this.at + count);
    this.at += count;
    return found;
  }
}

/** Of each frame and tire: three axes of deviations, then bytes of force, speed and strain. */
async function tireFrames(block) {
  const read = new Planes(await bytes("tires"));
  return block.times.map(() =>
    block.tires.map((tire) => {
      const deviation = [0, 1, 2].map(() => new Int16Array(tire.vertices));
      for (const axis of deviation) read.words(tire.vertices, axis);
      const [force, speed, strain] = [0, 1, 2].map(() => read.bytes(tire.vertices));
      return { deviation, force, speed, strain };
    }),
  );
}

async function grainFrames(block) {
  const read = new Planes(await bytes("grains")),
    count = block.bed.grains;
  let last = null;
  return block.times.map(() => {
    const frame = [0, 1, 2].map((axis) => {
      const values = new Uint16Array(count);
      read.words(count, values, last && last[axis]);
      return values;
    });
    last = frame;
    return { position: frame, speed: read.bytes(count) };
  });
}

async function surfaceFrames(block) {
  const read = new Planes(await bytes("surface")),
    count = block.bed.nx * block.bed.ny;
  let last = null;
  return block.times.map(() => {
    const values = new Int16Array(count);
    read.words(count, values, last);
    return (last = values);
  });
}

export async function unpack(block) {
  const tires = await tireFrames(block);
  if (!block.bed) return { tires, grains: null, surface: null };
  return { tires, grains: await grainFrames(block), surface: await surfaceFrames(block) };
}

/** Positions of a tire's vertices in a frame: the rigid motion of the reference, and the deviations from it. */
export function tirePositions(tire, reference, pose, deviation, out) {
  const [a, b, c, d, e, f, g, h, k, x, y, z] = pose;
  for (let i = 0; i < tire.vertices; i++) {
    const p = reference[3 * i],
      q = reference[3 * i + 1],
      r = reference[3 * i + 2];
    out[3 * i] = a * p + b * q + c * r + x + tire.quantum * deviation[0][i];
    out[3 * i + 1] = d * p + e * q + f * r + y + tire.quantum * deviation[1][i];
    out[3 * i + 2] = g * p + h * q + k * r + z + tire.quantum * deviation[2][i];
  }
  return out;
}

// The playback of a run in three dimensions, with a slider over its frames.
import {
  AmbientLight,
  Color,
  DirectionalLight,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { css, dark } from "./colours.js";
import { digits, el } from "./data.js";
import { Grains } from "./grains.js";
import { body, euler, hardGround, paint, Surface, Tire } from "./shapes.js";
import { unpack } from "./unpack.js";

const NUMBERS = 15; // of a pose: R, t, largest force, speed and strain
const root = (byte) => (byte / 255) ** 2; // share of the largest that a byte stands for

const OF_GRAINS = {
  height: ["height above the undisturbed surface", "mm", "earth"],
  speed: ["speed of grains", "m/s", "heat"],
  displacement: ["displacement of grains since the first frame", "mm", "viridis"],
};
const OF_TIRES = {
  plain: null,
  force: ["force on a point of the tire", "N", "rubber"],
  pressure: ["contact pressure on the tire", "kPa", "rubber"],
  speed: ["speed of the tire's surface", "m/s", "rubber"],
  height: ["height of the tire's surface", "m", "viridis"],
  strain: ["largest principal strain of the tire", "%", "viridis"],
};

/** Whether the browser draws without a graphics card; smooth edges and fine pixels would take too long then. */
function inSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) throw new Error("there is no such context");
  const about = gl.getExtension("WEBGL_debug_renderer_info");
  const name = about ? gl.getParameter(about.UNMASKED_RENDERER_WEBGL) : "";
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

class Player {
  constructor(block, arrays, frames) {
    Object.assign(this, {
      block,
      arrays,
      frames,
      number: -1,
      grainsBy: "height",
      tiresBy: block.bed ? "plain" : "pressure",
      follow: false,
      timer: null,
    });
    this.tires = block.tires.map((tire) => new Tire(tire, arrays));
    this.bed = block.bed && {
      surface: new Surface(block.bed),
      grains: new Grains(block.bed, arrays.get(block.bed.radius)),
    };
    this.poses = arrays.get(block.poses);
    this.chassis = block.chassis == null ? null : arrays.get(block.chassis);
    this.scales();
  }

  pose(frame, k) {
    const at = NUMBERS * (frame * this.tires.length + k);
    return this.poses.subarray(at, at + NUMBERS);
  }

  /** What the ends of the colour bars mean: a high share of all values, so that a single one does not set it. */
  scales() {
    const { block, frames } = this,
      high = (values) => {
        const sorted = values.sort((a, b) => a - b);
        return sorted.length ? sorted[Math.floor(0.98 * (sorted.length - 1))] || sorted.at(-1) || 1 : 1;
      };
    const forces = [],
      pressures = [],
      speeds = [],
      strains = [];
    frames.tires.forEach((tires, f) =>
      tires.forEach((tire, k) => {
        const [force, speed, strain] = this.pose(f, k).subarray(12);
        speeds.push(speed);
        strains.push(strain);
        let most = 0;
        for (let i = 0; i < tire.force.length; i++)
          if (tire.force[i])
            most = Math.max(most, (force * root(tire.force[i])) / (this.tires[k].area[i] || Infinity));
        forces.push(force);
        pressures.push(most);
      }),
    );
    this.tireTop = {
      force: high(forces),
      pressure: high(pressures) * 0.6,
      speed: high(speeds),
      height: 1,
      strain: high(strains),
    };
    this.strained = strains.some((strain) => strain > 0);
    if (!block.bed) return;
    const surface = this.bed.surface,
      heights = [...frames.surface[0]]
        .filter((v) => v !== -32768)
        .map((v) => surface.height(v))
        .sort((a, b) => a - b);
    this.level = heights[Math.floor(heights.length / 2)] ?? 0;
    const { scale, largest } = block.bed,
      first = frames.grains[0].position,
      last = frames.grains.at(-1).position,
      moved = [];
    for (let i = 0; i < block.bed.grains; i += 3)
      moved.push(Math.hypot(...[0, 1, 2].map((c) => (last[c][i] - first[c][i]) * scale[c])));
    const changes = [];
    const end = frames.surface.at(-1);
    for (let k = 0; k < end.length; k++)
      if (end[k] !== -32768 && frames.surface[0][k] !== -32768)
        changes.push(Math.abs(surface.height(end[k]) - surface.height(frames.surface[0][k])));
    this.grainTop = {
      height: Math.max(high(changes), 1.5 * largest),
      displacement: Math.max(high(moved), largest),
      speed: high([...block.bed.speeds]) * 0.5,
    };
  }

  start(canvas) {
    this.slow = inSoftware();
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.slow, preserveDrawingBuffer: true });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 2, 0.01, 500);
    this.camera.up.set(0, 0, 1);
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(-3, -5, 8);
    this.scene.add(
      sun,
      new HemisphereLight(0xdfe8f5, 0x8a7358, 1.4),
      new AmbientLight(0xffffff, 0.25),
      ...this.tires.map((tire) => tire.mesh),
    );
    if (this.bed) this.scene.add(this.bed.surface.mesh, this.bed.grains.points);
    this.place(0);
    const centres = this.tires.map((tire) => [...tire.centre]);
    this.radius = this.tires[0]?.radius || 0.5;
    if (this.chassis && centres.length > 1)
      this.scene.add((this.body = body(centres, this.radius, this.chassis.subarray(0, 6))));
    this.place(this.block.times.length - 1);
    const ends = this.tires.map((tire) => [...tire.centre]);
    const all = [...centres, ...ends],
      range = (k, pick) => pick(...all.map((p) => p[k]));
    this.from = [0, 1, 2].map((k) => range(k, Math.min));
    this.to = [0, 1, 2].map((k) => range(k, Math.max));
    if (!this.bed)
      this.scene.add(hardGround(this.block.ground, this.block.profile || [], this.from, this.to, this.radius));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.later());
    this.theme();
    this.look("corner");
  }

  theme() {
    this.scene.background = new Color(dark() ? 0x22262c : 0xe8eef4);
    this.later();
  }

  centre() {
    const sum = [0, 0, 0];
    for (const tire of this.tires) for (let k = 0; k < 3; k++) sum[k] += tire.centre[k] / this.tires.length;
    return sum;
  }

  /** Camera positions: seen from the side, the front, above, or a corner. */
  look(which) {
    const spread =
      this.tires.length > 1
        ? Math.max(
            ...[0, 1].map(
              (k) =>
                Math.max(...this.tires.map((t) => t.centre[k])) - Math.min(...this.tires.map((t) => t.centre[k])),
            ),
          )
        : 0;
    const size = 2.2 * this.radius + 0.75 * spread,
      sign = this.block.sign || 1,
      [x, y, z] = this.centre();
    const directions = {
      corner: [sign * 2.1, -2.6, 1.55],
      side: [0, -3.6, 0.35],
      front: [sign * 3.6, 0, 0.5],
      top: [0, -0.01, 3.9],
      behind: [-sign * 2.8, -1.7, 1.5],
    };
    this.controls.target.set(x, y, z - 0.35 * this.radius);
    this.camera.position
      .copy(this.controls.target)
      .add(new Vector3(...directions[which]).multiplyScalar(size * 0.85));
    this.controls.update();
    this.later();
  }

  later() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.pending = false;
    const canvas = this.renderer.domElement,
      width = canvas.clientWidth,
      height = canvas.clientHeight;
    if (!width || !height) return;
    const ratio = this.slow ? 1 : Math.min(devicePixelRatio, 1.5);
    if (canvas.width !== Math.floor(width * ratio) || canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    }
    if (this.bed)
      this.bed.grains.material.uniforms.pixels.value =
        canvas.height / (2 * Math.tan((this.camera.fov * Math.PI) / 360));
    this.renderer.render(this.scene, this.camera);
  }

  /** Puts everything where it is in a frame. */
  place(number) {
    const before = this.centre();
    this.number = number;
    this.tires.forEach((tire, k) => {
      tire.show(this.pose(number, k), this.frames.tires[number][k]);
      this.paintTire(tire, this.frames.tires[number][k], this.pose(number, k));
    });
    if (this.bed) this.placeBed(number);
    if (this.body) {
      const pose = this.chassis.subarray(6 * number, 6 * number + 6);
      this.body.position.set(pose[0], pose[1], pose[2]);
      this.body.setRotationFromEuler(euler(pose));
    }
    if (this.follow && this.controls) {
      const by = this.centre().map((v, k) => v - before[k]);
      this.controls.target.add(new Vector3(...by));
      this.camera.position.add(new Vector3(...by));
      this.controls.update();
    }
    if (this.controls) this.later();
  }

  paintTire(tire, frame, pose) {
    const [force, speed, strain] = pose.subarray(12),
      top = this.tireTop,
      by = this.tiresBy;
    const rim = (share) => (i) => (tire.rim[i] ? 0.02 : share(i));
    const z = tire.position.array,
      share = {
        plain: (i) => 0,
        force: (i) => (force * root(frame.force[i])) / top.force,
        speed: (i) => (speed * root(frame.speed[i])) / top.speed,
        strain: (i) => (strain * root(frame.strain[i])) / top.strain,
        pressure: (i) => (force * root(frame.force[i])) / (tire.area[i] || Infinity) / top.pressure,
        height: (i) => (z[3 * i + 2] - tire.centre[2]) / (2 * tire.radius) + 0.5,
      }[by];
    paint(tire.colour, tire.description.vertices, OF_TIRES[by]?.[2] || "rubber", by === "plain" ? share : rim(share));
    if (by === "plain")
      for (let i = 0; i < tire.description.vertices; i++)
        for (let c = 0; c < 3; c++) tire.colour.array[3 * i + c] = tire.rim[i] ? 0.3 : tire.sector[i] ? 0.075 : 0.035;
  }

  placeBed(number) {
    const { bed, block, frames } = this,
      grains = frames.grains[number],
      { low, scale } = block.bed,
      count = block.bed.grains;
    const shade = new Uint8Array(count),
      top = this.grainTop[this.grainsBy],
      first = frames.grains[0].position,
      now = grains.position;
    for (let i = 0; i < count; i++) {
      let share;
      if (this.grainsBy === "height")
        share = 0.5 + (0.5 * (low[2] + now[2][i] * scale[2] + block.bed.largest - this.level)) / top;
      else if (this.grainsBy === "speed") share = Math.sqrt((block.bed.speeds[number] * root(grains.speed[i])) / top);
      else
        share =
          Math.hypot(
            (now[0][i] - first[0][i]) * scale[0],
            (now[1][i] - first[1][i]) * scale[1],
            (now[2][i] - first[2][i]) * scale[2],
          ) / top;
      shade[i] = 255 * Math.min(Math.max(share, 0), 1);
    }
    bed.grains.map(OF_GRAINS[this.grainsBy][2]);
    bed.grains.show(grains, shade);
    const surface = bed.surface,
      drop = bed.grains.points.visible ? 2.2 * block.bed.largest : 0;
    if (!surface.mesh.visible) return;
    surface.show(frames.surface[number], drop);
    const heights = surface.position.array;
    paint(
      surface.colour,
      heights.length / 3,
      "earth",
      (k) => 0.5 + (0.5 * (heights[3 * k + 2] + drop - this.level)) / this.grainTop.height,
    );
  }
}

function scaleBar(player, kind) {
  const of = kind === "grains" ? OF_GRAINS[player.grainsBy] : OF_TIRES[player.tiresBy];
  if (!of || (kind === "grains" && !player.bed)) return null;
  const [words, unit, map] = of,
    top =
      (kind === "grains" ? player.grainTop[player.grainsBy] : player.tireTop[player.tiresBy]) *
      ({ mm: 1e3, kPa: 1e-3, "%": 100 }[unit] ?? 1);
  const ends =
    unit === "m"
      ? ["lowest", "highest"]
      : map === "earth"
        ? [`−${digits(top)}`, `+${digits(top)} ${unit}`]
        : ["0", `≥ ${digits(top)} ${unit}`];
  return el(
    "div",
    { class: "scale" },
    el("span", {}, ends[0]),
    el("i", { style: `background:${css(map)}` }),
    el("span", {}, ends[1]),
    el("b", {}, words),
  );
}

function choice(label, options, value, onchange) {
  const select = el(
    "select",
    { onchange: () => onchange(select.value) },
    ...options.map((name) => el("option", { value: name, selected: name === value }, name)),
  );
  return el("label", {}, `${label} `, select);
}

function box(label, checked, onchange) {
  const input = el("input", { type: "checkbox", checked, onchange: () => onchange(input.checked) });
  return el("label", { class: "box" }, input, ` ${label}`);
}

function controls(player, block, show, bars) {
  const again = () => {
    player.place(player.number);
    bars();
  };
  const { bed } = player;
  const toggles = [];
  if (bed) {
    toggles.push(
      choice("grains by", Object.keys(OF_GRAINS), player.grainsBy, (v) => {
        player.grainsBy = v;
        again();
      }),
    );
  }
  toggles.push(
    choice(
      "tire by",
      Object.keys(OF_TIRES).filter((by) => by !== "strain" || player.strained),
      player.tiresBy,
      (v) => {
        player.tiresBy = v;
        again();
      },
    ),
  );
  if (bed) {
    toggles.push(
      box("grains", true, (on) => {
        bed.grains.points.visible = on;
        again();
      }),
      box("surface", true, (on) => {
        bed.surface.mesh.visible = on;
        again();
      }),
    );
  }
  toggles.push(
    box("tires", true, (on) => {
      for (const tire of player.tires) tire.mesh.visible = on;
      again();
    }),
  );
  if (player.body)
    toggles.push(
      box("vehicle (schematic)", true, (on) => {
        player.body.visible = on;
        again();
      }),
    );
  toggles.push(
    box("follow", false, (on) => {
      player.follow = on;
    }),
  );
  const views = ["corner", "side", "front", "behind", "top"].map((name) =>
    el("button", { type: "button", onclick: () => player.look(name) }, name),
  );
  return el("div", { class: "controls" }, ...toggles, el("span", { class: "views" }, "view: ", ...views));
}

const players = [];

/** The block of the playback; made when it comes into view, for its data take a moment to unpack. */
export function playback(block, arrays) {
  const canvas = el("canvas", { class: "stage", tabIndex: 0 });
  const words = el("span", { class: "time" }, "");
  const slider = el("input", {
    type: "range",
    min: 0,
    max: block.times.length - 1,
    value: block.times.length - 1,
    step: 1,
    ariaLabel: "frame",
  });
  const button = el("button", { type: "button" }, "▶ play");
  const holder = el("div", { class: "playback" }, el("div", { class: "waiting" }, "unpacking the frames …"));
  const begin = async () => {
    let player;
    try {
      player = new Player(block, arrays, await unpack(block));
      player.start(canvas);
    } catch (error) {
      holder.replaceChildren(
        el(
          "p",
          { class: "text warn" },
          `The playback needs WebGL 2, which this browser does not offer here (${error.message}).`,
        ),
      );
      return;
    }
    players.push(player);
    const show = (number) => {
      slider.value = number;
      player.place(number);
      words.textContent = `t = ${block.times[number].toFixed(3)} s · frame ${number + 1} of ${block.times.length}`;
      holder.dataset.frame = number;
    };
    const stop = () => {
      clearTimeout(player.timer);
      player.timer = null;
      button.textContent = "▶ play";
    };
    const step = () => {
      if (player.number + 1 >= block.times.length) return stop();
      show(player.number + 1);
      player.timer = setTimeout(step, 60);
    };
    button.addEventListener("click", () => {
      if (player.timer) return stop();
      button.textContent = "❚❚ pause";
      if (player.number + 1 >= block.times.length) show(0);
      player.timer = setTimeout(step, 60);
    });
    slider.addEventListener("input", () => {
      stop();
      show(Number(slider.value));
    });
    const legend = el("div", { class: "scales" });
    const bars = () =>
      legend.replaceChildren(...[scaleBar(player, "grains"), scaleBar(player, "tires")].filter(Boolean));
    holder.replaceChildren(
      canvas,
      el("div", { class: "timeline" }, button, slider, words),
      controls(player, block, show, bars),
      legend,
      el("p", { class: "note" }, "Drag to turn, right button to move, wheel to zoom."),
    );
    bars();
    show(block.times.length - 1);
    new ResizeObserver(() => player.later()).observe(canvas);
    holder.player = player;
    holder.dataset.ready = "yes";
  };
  const seen = new IntersectionObserver(
    (entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      seen.disconnect();
      setTimeout(begin, 30);
    },
    { rootMargin: "400px" },
  );
  seen.observe(holder);
  return holder;
}

export function redraw() {
  for (const player of players) player.theme();
}

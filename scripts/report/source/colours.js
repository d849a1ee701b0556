// Colours of curves and of values.

// Okabe & Ito (2008): distinguishable with every kind of colour vision. Lighter on a dark page.
const LIGHT = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b8860b", "#3a9bd9", "#777777", "#7a4fbf"];
const DARK = ["#56b4e9", "#ff8a3d", "#2fd3a0", "#e9a3c9", "#f0c340", "#8fcdf5", "#b0b0b0", "#b394f0"];

export const dark = () => document.documentElement.dataset.theme === "dark";
export const curve = (k) => (dark() ? DARK : LIGHT)[k % LIGHT.length];
export const ink = () => (dark() ? "#d8dade" : "#2a2c30");
export const grid = () => (dark() ? "#34373d" : "#e6e6e6");
export const windowTint = () => (dark() ? "rgba(86,180,233,0.16)" : "rgba(0,114,178,0.10)");

// Viridis and a diverging map (blue: lower, brown: higher), as stops of linear interpolation.
const VIRIDIS = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];
const EARTH = [
  [23, 63, 95],
  [62, 124, 158],
  [168, 200, 210],
  [222, 205, 172],
  [190, 148, 95],
  [140, 90, 45],
  [88, 48, 18],
];
const HEAT = [
  [150, 130, 104],
  [176, 120, 70],
  [210, 96, 40],
  [236, 130, 30],
  [252, 190, 60],
  [255, 240, 160],
];
const RUBBER = [
  [58, 60, 66],
  [92, 62, 110],
  [170, 60, 90],
  [225, 90, 50],
  [250, 170, 50],
  [255, 245, 170],
];
export const MAPS = { viridis: VIRIDIS, earth: EARTH, heat: HEAT, rubber: RUBBER };

/** RGB, 0 to 255, of a share of 0 to 1 of a map. */
export function colour(map, share, out = [0, 0, 0]) {
  const stops = MAPS[map];
  const at = Math.min(Math.max(share || 0, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  for (let c = 0; c < 3; c++) out[c] = stops[k][c] + (at - k) * (stops[k + 1][c] - stops[k][c]);
  return out;
}

export function css(map) {
  return `linear-gradient(to right, ${MAPS[map].map((stop) => `rgb(${stop})`).join(", ")})`;
}

// Unpacks what page/blobs.py packed: deflated bytes in base64 inside of script elements.

/** The bytes of the element `id`; none where the page has no such element. */
export async function bytes(id) {
  const element = document.getElementById(id);
  if (!element) return new Uint8Array(0);
  const text = atob(element.textContent);
  element.remove();
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The arrays of the page: each is stored as four planes of bytes, the lowest first. */
export class Arrays {
  constructor(data, places) {
    this.data = data;
    this.places = places;
    this.made = new Map();
  }

  get(number) {
    if (!this.made.has(number)) {
      const [first, count] = this.places[number];
      const whole = new Uint8Array(4 * count);
      for (let plane = 0; plane < 4; plane++) {
        const at = 4 * first + plane * count;
        for (let i = 0; i < count; i++) whole[4 * i + plane] = this.data[at + i];
      }
      this.made.set(number, new Float32Array(whole.buffer));
    }
    return this.made.get(number);
  }
}

/** A number with four significant digits, and all digits before the point. */
export function digits(value) {
  if (value == null || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size < 1e-4 || size >= 1e7) return value.toExponential(3);
  return String(Number(value.toFixed(Math.max(0, Math.min(8, 3 - Math.floor(Math.log10(size)))))));
}

/** An element with attributes and children. */
export function el(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "class") made.className = value;
    else if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (name in made && name !== "for") made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child != null));
  return made;
}

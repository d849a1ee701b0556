// Grains as points that a shader makes look like spheres: one vertex each.
import { BufferAttribute, BufferGeometry, Points, ShaderMaterial, Vector3 } from "three";
import { MAPS } from "./colours.js";

const VERTEX = `
  attribute float size;
  attribute float shade;
  uniform vec3 low, scale;
  uniform float pixels;
  uniform vec3 stops[9];
  uniform float count;
  varying vec3 tint;
  void main() {
    float at = clamp(shade / 255.0, 0.0, 1.0) * (count - 1.0);
    int k = int(min(floor(at), count - 2.0));
    float speckle = 0.9 + 0.2 * fract(sin(float(gl_VertexID) * 12.9898) * 43758.5453);
    tint = mix(stops[k], stops[k + 1], at - float(k)) * speckle;
    vec4 eye = modelViewMatrix * vec4(position * scale + low, 1.0);
    gl_Position = projectionMatrix * eye;
    gl_PointSize = clamp(2.0 * size * pixels / gl_Position.w, 1.0, 64.0);
  }`;

const FRAGMENT = `
  varying vec3 tint;
  void main() {
    vec2 p = 2.0 * gl_PointCoord - 1.0;
    float r = dot(p, p);
    if (r > 1.0) discard;
    float light = 0.42 + 0.58 * max(0.0, dot(vec3(p.x, -p.y, sqrt(1.0 - r)), vec3(-0.34, 0.62, 0.70)));
    gl_FragColor = vec4(tint * light, 1.0);
  }`;

/** The grains of a bed; `show` puts those of a frame with one byte of colour each. */
export class Grains {
  constructor(bed, radius) {
    const geometry = new BufferGeometry();
    this.position = new BufferAttribute(new Uint16Array(3 * bed.grains), 3);
    this.shade = new BufferAttribute(new Uint8Array(bed.grains), 1);
    geometry.setAttribute("position", this.position);
    geometry.setAttribute("shade", this.shade);
    geometry.setAttribute("size", new BufferAttribute(radius, 1));
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        low: { value: new Vector3(...bed.low) },
        scale: { value: new Vector3(...bed.scale) },
        pixels: { value: 500 },
        stops: { value: Array.from({ length: 9 }, () => new Vector3()) },
        count: { value: 9 },
      },
    });
    this.points = new Points(geometry, this.material);
    this.points.frustumCulled = false;
  }

  map(name) {
    MAPS[name].forEach((stop, k) => this.material.uniforms.stops.value[k].set(...stop.map((v) => v / 255)));
    this.material.uniforms.count.value = MAPS[name].length;
  }

  show(frame, shade) {
    const [x, y, z] = frame.position,
      out = this.position.array;
    for (let i = 0; i < x.length; i++) {
      out[3 * i] = x[i];
      out[3 * i + 1] = y[i];
      out[3 * i + 2] = z[i];
    }
    this.position.needsUpdate = true;
    this.shade.array.set(shade);
    this.shade.needsUpdate = true;
  }
}

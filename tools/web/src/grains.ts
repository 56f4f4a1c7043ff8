/** Grains and forces by WebGL2: each grain a square, each contact a bar, all of one kind in one call. Spheres are shaded
 *  squares that face the eye. Instances of one square take a software renderer 20 us each. */
import { contactColumns, grainColumns, type Picture } from "./messages";

/* `axes` are the rows of the eye: right, up, towards it. Edges are smoothed over a pixel by the shaders themselves:
   samples of the whole canvas cost more than the grains where no graphics card draws. */
const place = `vec2 seen(vec3 p) { return (axes * (p - centre)).xy; } float depth(vec3 p) { return -(axes * (p - centre)).z * scale.y * 0.5; }`;
const head = `#version 300 es
uniform mat3 axes; uniform vec3 centre; uniform vec2 scale; uniform float pixel;
#define corner vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1)`;
const grainVertex = `${head}
in vec3 at; in float angle; in vec2 half_axes; in float load; uniform float mean;
out vec2 q; out float warm; ${place}
void main() { q = corner; warm = clamp(load / (4.0 * mean), 0.0, 1.0);
  vec2 along = vec2(cos(angle), sin(angle)); vec2 c = corner * half_axes;
  gl_Position = vec4((seen(at) + along * c.x + vec2(-along.y, along.x) * c.y) * scale, depth(at), 1); }`;
const grainFragment = `#version 300 es
precision highp float; in vec2 q; in float warm; uniform vec4 fill; uniform vec4 rim; uniform bool shaded; out vec4 color;
void main() { float d = length(q); float w = fwidth(d); float inside = 1.0 - smoothstep(1.0 - w, 1.0, d);
  if (inside <= 0.0) discard;
  if (!shaded) { color = vec4(mix(fill, rim, smoothstep(0.9 - w, 0.9, d)).rgb, inside); return; }
  vec3 n = vec3(q, sqrt(max(0.0, 1.0 - d * d))); float light = 0.35 + 0.65 * max(0.0, dot(n, vec3(-0.41, 0.57, 0.71)));
  color = vec4(mix(fill.rgb, vec3(0.86, 0.24, 0.1), warm) * light, 1.0); }`;
const forceVertex = `${head}
in vec3 from; in vec3 branch; in float force; uniform float mean; uniform float width;
out float warm; out float across; out float edge; ${place}
void main() { float share = min(1.2, force / (4.0 * mean)); vec2 bar = (axes * branch).xy;
  edge = width * (0.15 + share); across = (edge + pixel) * corner.y;
  vec2 p = seen(from) + bar * (corner.x * 0.5 + 0.5) + normalize(vec2(-bar.y, bar.x)) * across;
  warm = clamp(share * 1.2, 0.0, 1.0); gl_Position = vec4(p * scale, -1, 1); }`;
const forceFragment = `#version 300 es
precision highp float; in float warm; in float across; in float edge; uniform float pixel; out vec4 color;
void main() { float inside = clamp((edge - abs(across)) / pixel + 0.5, 0.0, 1.0);
  color = vec4(mix(vec3(0.15, 0.42, 0.75), vec3(0.85, 0.2, 0.1), warm), (0.35 + 0.65 * warm) * inside); }`;

/** A program that draws squares or bars, each of a row of numbers. */
class Squares {
  private readonly program: WebGLProgram;
  private readonly array: WebGLVertexArrayObject;
  private readonly buffer: WebGLBuffer;
  private readonly places = new Map<string, WebGLUniformLocation | null>();
  private vertices = new Float32Array();
  private room = 0;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    vertex: string,
    fragment: string,
    private readonly columns: readonly (readonly [string, number])[],
  ) {
    const program = (this.program = gl.createProgram()!);
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "WebGL");
    this.array = gl.createVertexArray()!;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    this.buffer = gl.createBuffer()!;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    let offset = 0;
    for (const [name, size] of columns) {
      const at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * this.width, offset);
      offset += 4 * size;
    }
  }

  get width() {
    return this.columns.reduce((sum, [, size]) => sum + size, 0);
  }

  set(values: Record<string, number | readonly number[]>) {
    const gl = this.gl;
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(values)) {
      if (!this.places.has(name)) this.places.set(name, gl.getUniformLocation(this.program, name));
      const at = this.places.get(name)!;
      if (typeof value === "number") name === "shaded" ? gl.uniform1i(at, value) : gl.uniform1f(at, value);
      else if (value.length === 9) gl.uniformMatrix3fv(at, false, value);
      else [gl.uniform2fv, gl.uniform3fv, gl.uniform4fv][value.length - 2].call(gl, at, value as number[]);
    }
  }

  draw(rows: Float32Array) {
    const { gl, width } = this;
    const count = rows.length / width;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    if (count > this.room) this.make(Math.ceil(1.5 * count));
    for (let k = 0; k < count; ++k) {
      const row = rows.subarray(k * width, (k + 1) * width);
      for (let each = 0; each < 4; ++each) this.vertices.set(row, (4 * k + each) * width);
    }
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, this.vertices, 0, 4 * rows.length);
    gl.drawElements(gl.TRIANGLES, 6 * count, gl.UNSIGNED_INT, 0);
  }

  /** Room for so many squares, two triangles each. */
  private make(count: number) {
    const gl = this.gl;
    this.room = count;
    this.vertices = new Float32Array(4 * count * this.width);
    gl.bufferData(gl.ARRAY_BUFFER, this.vertices.byteLength, gl.DYNAMIC_DRAW);
    const triangles = Uint32Array.from({ length: 6 * count }, (_, k) => 4 * Math.floor(k / 6) + [0, 1, 2, 2, 1, 3][k % 6]);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
  }
}

/** Moves each point into the cell, whose edges are the columns of `cell`; in place, so a second call changes nothing. */
function bringHome(cell: Float64Array, dimension: number, rows: Float32Array, width: number) {
  const [a, b] = [cell.subarray(0, 3), cell.subarray(3, 6)];
  const c = dimension === 2 ? [0, 0, 1] : cell.subarray(6, 9);
  const cross = (u: ArrayLike<number>, v: ArrayLike<number>) =>
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]] as const;
  const dot = (u: ArrayLike<number>, v: ArrayLike<number>) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const edges = [a, b, c].slice(0, dimension);
  const faces = [cross(b, c), cross(c, a), cross(a, b)].map((face) => face.map((each) => each / dot(a, cross(b, c))));
  for (let k = 0; k < rows.length; k += width) {
    const shifts = edges.map((_, e) => Math.floor(dot(rows.subarray(k, k + 3), faces[e])));
    edges.forEach((edge, e) => {
      for (let i = 0; i < 3; ++i) rows[k + i] -= shifts[e] * edge[i];
    });
  }
}

/** One grain of no size and one contact. */
const noPicture: Picture = {
  dimension: 2,
  cell: Float64Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1),
  grains: new Float32Array(grainColumns),
  contacts: new Float32Array(contactColumns),
  void_ratio: 0,
  coordination: 0,
  stress: new Float64Array(6),
};

export class GrainView {
  private readonly gl: WebGL2RenderingContext;
  private readonly grains: Squares;
  private readonly bars: Squares;
  /** Drawn without a graphics card: fewer pixels while the grains move. */
  private readonly slow: boolean;
  private colours: { fill: number[]; rim: number[]; paper: number[] } | null = null;
  private picture: Picture | null = null;
  private moving = false;
  private wanted = false;
  private turned = { azimuth: 0.5, height: 0.35 }; // radians, of the eye; spheres

  constructor(private readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false });
    if (!gl) throw new Error("WebGL 2 is switched off in this browser; switch it on, or use another one");
    this.gl = gl;
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    this.slow = /swiftshader|llvmpipe|software|basic render/i.test(String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER)));
    this.grains = new Squares(gl, grainVertex, grainFragment, [["at", 3], ["angle", 1], ["half_axes", 2], ["load", 1]]);
    this.bars = new Squares(gl, forceVertex, forceFragment, [["from", 3], ["branch", 3], ["force", 1]]);
    // Drivers compile a shader when it draws for the first time, which must not be while the first test runs.
    this.picture = noPicture;
    this.draw();
    this.picture = null;
    new ResizeObserver(() => this.redraw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.colours = null;
      this.redraw();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0 || this.picture?.dimension !== 3) return;
      this.turned.azimuth -= event.movementX / 150;
      this.turned.height = Math.min(1.5, Math.max(-1.5, this.turned.height + event.movementY / 150));
      this.redraw();
    });
  }

  /** `moving`: another picture follows. */
  show(picture: Picture, moving: boolean) {
    bringHome(picture.cell, picture.dimension, picture.grains, grainColumns);
    bringHome(picture.cell, picture.dimension, picture.contacts, contactColumns);
    this.picture = picture;
    this.moving = moving;
    this.redraw();
  }

  /** What is seen, as a PNG: drawn now, since a canvas that was shown is empty. */
  save(give: (file: Blob) => void) {
    this.moving = false;
    this.draw();
    this.canvas.toBlob((file) => file && give(file), "image/png");
  }

  private redraw() {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.draw();
    });
  }

  private colour() {
    if (this.colours !== null) return this.colours;
    const style = getComputedStyle(this.canvas);
    const colour = (text: string) => [...text.match(/\d+/g)!.slice(0, 3).map((part) => Number(part) / 255), 1];
    const [fill, rim] = ["--grain", "--grain-rim"].map((name) => colour(style.getPropertyValue(name)));
    return (this.colours = { fill, rim, paper: colour(style.backgroundColor) });
  }

  private draw() {
    const { gl, canvas, picture } = this;
    const density = Math.min(2, window.devicePixelRatio) * (this.slow && this.moving ? 0.5 : 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(1, Math.round(size * density)));
    // Setting a size, even the same one, gives the canvas new memory.
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    gl.viewport(0, 0, width, height);
    const { fill, rim, paper } = this.colour();
    gl.clearColor(paper[0], paper[1], paper[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!picture) return;
    const space = picture.dimension === 3;
    const axes = space ? this.eye() : [1, 0, 0, 0, 1, 0, 0, 0, 1];
    const { cell, grains, contacts } = picture;
    const edges = [0, 3, 6].slice(0, picture.dimension);
    const centre = [0, 1, 2].map((k) => edges.reduce((sum, e) => sum + cell[e + k] / 2, 0));
    // Half of what is seen: of the cell's edges along each axis of the eye, which spheres are turned about.
    const across = space
      ? [0, 0].fill(edges.reduce((sum, e) => sum + Math.hypot(cell[e], cell[e + 1], cell[e + 2]) ** 2, 0) ** 0.5 * 0.42)
      : [0, 1].map((k) => edges.reduce((sum, e) => sum + Math.abs(cell[e + k]) / 2, 0));
    const half = 1.06 * Math.max(across[1], (across[0] * height) / width);
    const scale = [height / width / half, 1 / half];
    let [mean, radius] = [0, 0];
    for (let k = contactColumns - 1; k < contacts.length; k += contactColumns) mean += (contacts[k] * contactColumns) / contacts.length;
    for (let k = 4; k < grains.length; k += grainColumns) radius += (grains[k] * grainColumns) / grains.length;
    mean ||= 1;
    const view = { axes, centre, scale, pixel: (2 * half) / height };
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    if (space) gl.enable(gl.DEPTH_TEST);
    else gl.disable(gl.DEPTH_TEST);
    // A sphere has some six contacts.
    this.grains.set({ ...view, fill, rim, shaded: Number(space), mean: 3 * mean });
    this.grains.draw(grains);
    if (space || contacts.length === 0) return;
    this.bars.set({ ...view, mean, width: 0.35 * radius });
    this.bars.draw(contacts);
  }

  /** Rows right, up and towards the eye, as the columns of WebGL; z is up. */
  private eye() {
    const { azimuth, height } = this.turned;
    const [s, c, up, level] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(height), Math.cos(height)];
    const [right, above, towards] = [[c, s, 0], [s * up, -c * up, level], [s * level, -c * level, up]];
    return [0, 1, 2].flatMap((k) => [right[k], above[k], towards[k]]);
  }
}

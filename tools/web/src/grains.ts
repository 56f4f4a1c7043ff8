/** Grains and forces by WebGL2: each grain an instance of one square, each contact an instance of one bar. */
import type { Picture } from "./messages";

const grainVertex = `#version 300 es
in vec2 corner; in vec2 at; in float r; uniform vec4 view; out vec2 q;
void main() { q = corner; gl_Position = vec4((at + corner * r - view.xy) * view.zw, 0, 1); }`;
const grainFragment = `#version 300 es
precision highp float; in vec2 q; uniform vec4 fill; uniform vec4 rim; out vec4 color;
void main() { float d = length(q); float w = fwidth(d);
  float inside = 1.0 - smoothstep(1.0 - w, 1.0, d); if (inside <= 0.0) discard;
  color = mix(fill, rim, smoothstep(0.9 - w, 0.9, d)) * vec4(1, 1, 1, inside); }`;
const forceVertex = `#version 300 es
in vec2 corner; in vec4 bar; in float share; uniform vec4 view; uniform float width; out float warm;
void main() { vec2 across = normalize(vec2(-bar.w, bar.z)) * width * (0.15 + share);
  vec2 p = bar.xy + bar.zw * (corner.x * 0.5 + 0.5) + across * corner.y;
  warm = clamp(share * 1.2, 0.0, 1.0); gl_Position = vec4((p - view.xy) * view.zw, 0, 1); }`;
const forceFragment = `#version 300 es
precision highp float; in float warm; out vec4 color;
void main() { color = vec4(mix(vec3(0.15, 0.42, 0.75), vec3(0.85, 0.2, 0.1), warm), 0.35 + 0.65 * warm); }`;

interface Program {
  program: WebGLProgram;
  array: WebGLVertexArrayObject;
  buffer: WebGLBuffer;
}

export class GrainView {
  private readonly gl: WebGL2RenderingContext;
  private readonly discs: Program;
  private readonly bars: Program;
  private picture: Picture | null = null;
  private wanted = false;
  /** Pictures drawn so far. */
  frames = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("WebGL 2 is switched off in this browser; switch it on, or use another one");
    this.gl = gl;
    this.discs = this.build(grainVertex, grainFragment, [["at", 2], ["r", 1]]);
    this.bars = this.build(forceVertex, forceFragment, [["bar", 4], ["share", 1]]);
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  show(picture: Picture) {
    this.picture = picture;
    this.redraw();
  }

  redraw() {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.draw();
    });
  }

  private build(vertex: string, fragment: string, columns: [string, number][]): Program {
    const gl = this.gl;
    const program = gl.createProgram()!;
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "WebGL");
    const array = gl.createVertexArray()!;
    gl.bindVertexArray(array);
    const square = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, square);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
    const corner = gl.getAttribLocation(program, "corner");
    gl.enableVertexAttribArray(corner);
    gl.vertexAttribPointer(corner, 2, gl.FLOAT, false, 0, 0);
    const buffer = gl.createBuffer()!;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    const stride = 4 * columns.reduce((sum, [, size]) => sum + size, 0);
    let offset = 0;
    for (const [name, size] of columns) {
      const place = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
      gl.vertexAttribDivisor(place, 1);
      offset += 4 * size;
    }
    return { program, array, buffer };
  }

  private draw() {
    const { gl, canvas, picture } = this;
    const scale = window.devicePixelRatio;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(1, Math.round(size * scale)));
    // Setting a size, even the same one, gives the canvas new memory.
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!picture) return;
    ++this.frames;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    const [ax, ay, bx, by] = picture.cell;
    const size = 1.06 * Math.max(ax + Math.abs(bx), by + Math.abs(ay), ((ax + Math.abs(bx)) * canvas.height) / canvas.width);
    const centre = [(ax + bx) / 2, (ay + by) / 2];
    const view = [centre[0], centre[1], (2 / size) * (canvas.height / canvas.width), 2 / size];
    this.drawGrains(picture, view);
    this.drawForces(picture, view);
  }

  private instances(of: Program, rows: Float32Array, columns: number, view: number[]) {
    const gl = this.gl;
    gl.useProgram(of.program);
    gl.uniform4f(gl.getUniformLocation(of.program, "view"), view[0], view[1], view[2], view[3]);
    gl.bindVertexArray(of.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, of.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, rows, gl.DYNAMIC_DRAW);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, rows.length / columns);
  }

  /** The place of a point in the cell, between 0 and its edges. */
  private home(cell: Float64Array, x: number, y: number): [number, number] {
    const [ax, ay, bx, by] = cell;
    const area = ax * by - ay * bx;
    const u = Math.floor((x * by - y * bx) / area);
    const v = Math.floor((ax * y - ay * x) / area);
    return [x - u * ax - v * bx, y - u * ay - v * by];
  }

  private drawGrains({ cell, grains }: Picture, view: number[]) {
    const gl = this.gl;
    const rows = new Float32Array(grains.length / 2);
    for (let k = 0, to = 0; k < grains.length; k += 6) {
      const [x, y] = this.home(cell, grains[k], grains[k + 1]);
      rows[to++] = x;
      rows[to++] = y;
      rows[to++] = grains[k + 2];
    }
    gl.useProgram(this.discs.program);
    const style = getComputedStyle(this.canvas);
    const channel = (name: string) => style.getPropertyValue(name).split(",").map((part) => Number(part) / 255);
    const [fill, rim] = [channel("--grain"), channel("--grain-rim")];
    gl.uniform4f(gl.getUniformLocation(this.discs.program, "fill"), fill[0], fill[1], fill[2], 1);
    gl.uniform4f(gl.getUniformLocation(this.discs.program, "rim"), rim[0], rim[1], rim[2], 1);
    this.instances(this.discs, rows, 3, view);
  }

  private drawForces({ cell, contacts, grains }: Picture, view: number[]) {
    if (contacts.length === 0) return;
    let mean = 0;
    for (let k = 4; k < contacts.length; k += 6) mean += (contacts[k] * 6) / contacts.length;
    const rows = new Float32Array((contacts.length / 6) * 5);
    for (let k = 0, to = 0; k < contacts.length; k += 6) {
      const [x, y] = this.home(cell, contacts[k], contacts[k + 1]);
      rows[to++] = x;
      rows[to++] = y;
      rows[to++] = contacts[k + 2];
      rows[to++] = contacts[k + 3];
      rows[to++] = Math.min(1.2, contacts[k + 4] / (4 * mean || 1));
    }
    const gl = this.gl;
    let radius = 0;
    for (let k = 2; k < grains.length; k += 6) radius += (grains[k] * 6) / grains.length;
    gl.useProgram(this.bars.program);
    gl.uniform1f(gl.getUniformLocation(this.bars.program, "width"), 0.35 * radius);
    this.instances(this.bars, rows, 5, view);
  }
}

// The specimen, drawn by three.js: a rectangle a grain that its shader makes a disc, an ellipse or a lit sphere; a
// ribbon a contact; the cell as lines. A browser without WebGL 2 gets the same picture as SVG.
import { BufferAttribute, BufferGeometry, Color, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry,
  LineSegments, Mesh, MOUSE, OrthographicCamera, RawShaderMaterial, Scene, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { ink, paper } from "./palette";
import type { Picture } from "./picture";

const grainVertex = `precision highp float; precision highp int;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform int kind;
in vec2 position; in vec3 centre; in vec2 half_; in float angle; in vec3 colour; in float round;
out vec2 at; out vec3 tint; out float depth; flat out float radius; flat out float is_round;
void main() {
  at = position; tint = colour; radius = half_.x; is_round = round;
  vec4 middle = modelViewMatrix * vec4(centre, 1.0);
  vec2 corner = position * half_;
  if (kind == 1 || kind == 3) corner = mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * corner;
  middle.xy += corner;
  depth = middle.z;
  gl_Position = projectionMatrix * middle;
}`;
const grainFragment = `precision highp float; precision highp int;
uniform mat4 projectionMatrix; uniform int kind; uniform float edge;
in vec2 at; in vec3 tint; in float depth; flat in float radius; flat in float is_round;
out vec4 result;
void main() {
  float r = dot(at, at);
  vec3 shade = tint;
  float z = depth;
  if (is_round > 0.5) {
    if (r > 1.0) discard;
    if (kind == 2) {
      float high = sqrt(1.0 - r);
      z += radius * high;
      shade *= 0.45 + 0.55 * max(0.0, dot(vec3(at, high), normalize(vec3(-0.4, 0.6, 0.75))));
    }
    if (r > edge) shade *= 0.55;
  }
  vec4 clip = projectionMatrix * vec4(0.0, 0.0, z, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  result = vec4(shade, 1.0);
}`;
const chainVertex = `precision highp float; precision highp int;
uniform mat4 modelViewMatrix, projectionMatrix; uniform float lift;
in vec2 position; in vec3 begin; in vec3 end; in float width; in vec3 colour;
out vec3 tint;
void main() {
  tint = colour;
  vec4 a = modelViewMatrix * vec4(begin, 1.0), b = modelViewMatrix * vec4(end, 1.0);
  vec2 along = b.xy - a.xy;
  float size = length(along);
  vec2 across = size > 0.0 ? vec2(-along.y, along.x) / size : vec2(0.0, 1.0);
  vec4 place = mix(a, b, position.x);
  place.xy += across * position.y * width;
  place.z += lift;
  gl_Position = projectionMatrix * place;
}`;
const chainFragment = `precision highp float; precision highp int;
in vec3 tint; out vec4 result;
void main() { result = vec4(tint, 1.0); }`;

const boxVertex = `precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
in vec3 position;
void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`;
const boxFragment = `precision highp float;
uniform vec3 colour; out vec4 result;
void main() { result = vec4(colour, 1.0); }`;

// An ellipsoid: the points p about its centre with p M p = 1, seen along z.
const rockVertex = `precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
in vec2 position; in vec3 centre; in vec3 first; in vec3 second; in vec3 third;
out vec2 at; out float depth; flat out mat3 form;
void main() {
  mat3 axes = mat3(modelViewMatrix) * mat3(first, second, third), back = inverse(axes);
  form = transpose(back) * back;
  at = position * vec2(length(vec3(axes[0].x, axes[1].x, axes[2].x)), length(vec3(axes[0].y, axes[1].y, axes[2].y)));
  vec4 middle = modelViewMatrix * vec4(centre, 1.0);
  middle.xy += at;
  depth = middle.z;
  gl_Position = projectionMatrix * middle;
}`;
const rockFragment = `precision highp float;
uniform mat4 projectionMatrix;
in vec2 at; in float depth; flat in mat3 form;
out vec4 result;
void main() {
  float b = form[0][2] * at.x + form[1][2] * at.y;
  float c = form[0][0] * at.x * at.x + 2.0 * form[0][1] * at.x * at.y + form[1][1] * at.y * at.y - 1.0;
  float root = b * b - form[2][2] * c;
  if (root < 0.0) discard;
  float z = (sqrt(root) - b) / form[2][2];
  vec3 normal = normalize(form * vec3(at, z));
  vec4 clip = projectionMatrix * vec4(0.0, 0.0, depth + z, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  result = vec4(vec3(0.62) * (0.45 + 0.55 * max(0.0, dot(normal, normalize(vec3(-0.4, 0.6, 0.75))))), 1.0);
}`;

/** Geometry of one quad, drawn once for each entry of its attributes; they are made longer when more are needed. */
class Instances {
  readonly geometry = new InstancedBufferGeometry();
  private room = -1;
  constructor(corners: number[], private widths: Record<string, number>) {
    this.geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 2));
    this.geometry.setIndex([0, 1, 2, 2, 1, 3]);
  }
  set(count: number, values: Record<string, Float32Array>) {
    if (count > this.room) {
      this.geometry.dispose();
      this.room = Math.ceil(1.2 * count) + 16;
      for (const [name, width] of Object.entries(this.widths))
        this.geometry.setAttribute(name, new InstancedBufferAttribute(new Float32Array(this.room * width), width));
    }
    for (const name of Object.keys(this.widths)) {
      const attribute = this.geometry.getAttribute(name) as InstancedBufferAttribute;
      (attribute.array as Float32Array).set(values[name].subarray(0, count * this.widths[name]));
      attribute.needsUpdate = true;
    }
    this.geometry.instanceCount = count;
  }
}

export class Viewer {
  readonly camera = new OrthographicCamera(-1, 1, 1, -1, -10, 10);
  readonly controls?: OrbitControls;
  private renderer?: WebGLRenderer;
  private scene = new Scene();
  private grains = new Instances([-1, -1, 1, -1, -1, 1, 1, 1], { centre: 3, half_: 2, angle: 1, colour: 3, round: 1 });
  private chains = new Instances([0, -0.5, 1, -0.5, 0, 0.5, 1, 0.5], { begin: 3, end: 3, width: 1, colour: 3 });
  private rocks = new Instances([-1, -1, 1, -1, -1, 1, 1, 1], { centre: 3, first: 3, second: 3, third: 3 });
  private rockMaterial = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: rockVertex, fragmentShader: rockFragment });
  private grainMaterial = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: grainVertex, fragmentShader: grainFragment,
    uniforms: { kind: { value: 0 }, edge: { value: 0.85 } } });
  private chainMaterial = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: chainVertex, fragmentShader: chainFragment,
    uniforms: { lift: { value: 0 } } });
  private boxMaterial = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: boxVertex, fragmentShader: boxFragment,
    uniforms: { colour: { value: new Color() } } });
  private box = new LineSegments(new BufferGeometry(), this.boxMaterial);
  private size = [0, 0, 0];
  private waits = 0;
  private reach = 0;
  private dimension = 0;
  private picture?: Picture;

  constructor(readonly place: HTMLElement, private asSvg: (viewer: Viewer) => string) {
    try {
      this.renderer = new WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
    } catch {
      place.classList.add("no-webgl");
      new ResizeObserver(() => this.draw()).observe(place);
      return;
    }
    this.renderer.sortObjects = false;
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    place.append(canvas);
    for (const [geometry, material] of [[this.grains.geometry, this.grainMaterial], [this.chains.geometry, this.chainMaterial],
      [this.rocks.geometry, this.rockMaterial]] as const) {
      const mesh = new Mesh(geometry, material);
      mesh.frustumCulled = false;
      this.scene.add(mesh);
    }
    this.box.frustumCulled = false;
    this.scene.add(this.box);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableZoom = false; // the wheel scrolls the page until the picture has been clicked
    canvas.addEventListener("focus", () => { this.controls!.enableZoom = true; });
    canvas.addEventListener("blur", () => { this.controls!.enableZoom = false; });
    canvas.addEventListener("keydown", (event) => this.key(event));
    this.controls.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(place);
  }

  /** Brings the whole picture into sight. */
  reset() {
    if (!this.picture) return;
    const { low, high, dimension } = this.picture;
    const middle = low.map((value, k) => (value + high[k]) / 2) as [number, number, number];
    this.reach = Math.hypot(...high.map((value, k) => value - low[k]));
    const from = dimension === 2 ? [0, 0, 1] : [0.55, -0.75, 0.35];
    const size = Math.hypot(...from);
    this.camera.up.set(0, dimension === 2 ? 1 : 0, dimension === 2 ? 0 : 1);
    this.camera.position.set(...(middle.map((value, k) => value + (from[k] / size) * this.reach) as [number, number, number]));
    this.camera.zoom = 1;
    this.camera.lookAt(...middle);
    if (this.controls) {
      this.controls.target.set(...middle);
      this.controls.enableRotate = dimension === 3;
      this.controls.mouseButtons.LEFT = dimension === 3 ? MOUSE.ROTATE : MOUSE.PAN;
      // In the plane one finger scrolls the page, two move the picture.
      (this.place.firstElementChild as HTMLElement).style.touchAction = dimension === 3 ? "none" : "pan-y";
      this.controls.update();
    }
    this.draw();
  }

  zoom(by: number) {
    this.camera.zoom = Math.min(50, Math.max(0.3, this.camera.zoom * by));
    this.draw();
  }

  private key(event: KeyboardEvent) {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.key === "+" || event.key === "=") this.zoom(1.25);
    else if (event.key === "-") this.zoom(0.8);
    else if (event.key === "0") this.reset();
    else if (turn && this.controls) {
      const target = this.controls.target, by = this.dimension === 2 ? (0.05 * this.reach) / this.camera.zoom : 0.12;
      if (this.dimension === 2) {
        const move = new Vector3(by * turn[0], by * turn[1], 0);
        target.add(move);
        this.camera.position.add(move);
      } else {
        const arm = this.camera.position.clone().sub(target), side = arm.clone().cross(this.camera.up).normalize();
        arm.applyAxisAngle(this.camera.up, by * turn[0]);
        const tilted = arm.clone().applyAxisAngle(side, -by * turn[1]);
        if (Math.abs(tilted.clone().normalize().dot(this.camera.up)) < 0.98) arm.copy(tilted);
        this.camera.position.copy(target).add(arm);
      }
      this.controls.update();
      this.draw();
    } else return;
    event.preventDefault();
  }

  show(picture: Picture, description: string) {
    const first = !this.picture || this.dimension !== picture.dimension || this.picture.of !== picture.of;
    this.picture = picture;
    this.dimension = picture.dimension;
    if (this.renderer) {
      this.grainMaterial.uniforms.kind.value = picture.kind;
      this.chainMaterial.uniforms.lift.value = picture.dimension === 2 ? picture.largest * 2 : 0;
      this.grains.set(picture.count, { centre: picture.position, half_: picture.half, angle: picture.angle, colour: picture.colour,
        round: picture.round });
      const part = (from: number) => Float32Array.from(picture.rocks.flatMap((rock) => rock.slice(from, from + 3)));
      this.rocks.set(picture.rocks.length, { centre: part(0), first: part(3), second: part(6), third: part(9) });
      this.chains.set(picture.chains, { begin: picture.begin, end: picture.end, width: picture.width, colour: picture.chainColour });
      this.box.geometry.dispose();
      this.box.geometry.setAttribute("position", new BufferAttribute(picture.edges, 3));
      this.box.renderOrder = 1;
      this.renderer.domElement.setAttribute("aria-label", description);
    }
    if (first) this.reset();
    else this.draw();
  }

  draw() {
    if (!this.picture) return;
    const width = this.place.clientWidth, height = this.place.clientHeight;
    if (width < 2 || height < 2) return;
    this.frame(width, height);
    if (!this.renderer) {
      this.place.innerHTML = this.asSvg(this);
      return;
    }
    this.boxMaterial.uniforms.colour.value = new Color(ink()).convertLinearToSRGB();
    this.renderer.setClearColor(paper());
    this.render(width, height, 1);
    clearTimeout(this.waits);
    this.waits = window.setTimeout(() => this.render(width, height, 2), 180);
  }

  /** Coarse while things move, so that a computer without a graphics card follows; fine when they rest. */
  private render(width: number, height: number, ratio: number) {
    if (width !== this.size[0] || height !== this.size[1] || ratio !== this.size[2]) {
      this.renderer!.setPixelRatio(ratio);
      this.renderer!.setSize(width, height);
      this.size = [width, height, ratio];
    }
    this.renderer!.render(this.scene, this.camera);
    this.place.dataset.drawn = ratio > 1 ? "fine" : "coarse";
  }

  /** The camera holds the picture within the place, whatever its proportions. */
  private frame(width: number, height: number) {
    const { low, high, dimension } = this.picture!;
    const wide = dimension === 3 ? this.reach : high[0] - low[0], tall = dimension === 3 ? this.reach : high[1] - low[1];
    const scale = Math.max(wide / width, tall / height) * (dimension === 3 ? 0.47 : 0.52);
    Object.assign(this.camera, { left: -scale * width, right: scale * width, top: scale * height, bottom: -scale * height,
      near: -4 * this.reach, far: 4 * this.reach });
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /** Pixels from the upper left, and depth, of a point. */
  project(x: number, y: number, z: number): [number, number, number] {
    const point = new Vector3(x, y, z).project(this.camera);
    return [(point.x + 1) / 2 * this.place.clientWidth, (1 - point.y) / 2 * this.place.clientHeight, point.z];
  }
  pixelsPerMetre() { return (this.place.clientWidth * this.camera.zoom) / (this.camera.right - this.camera.left); }
}

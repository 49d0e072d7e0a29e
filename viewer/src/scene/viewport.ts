/** The canvas: camera, orbiting, drawing on demand, and the translation between pixels and rays. */
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { DetailChooser } from "../model/detail.ts";

// Colours are the page's own, written straight to the screen.
THREE.ColorManagement.enabled = false;

/**
 * True where the browser has no graphics card to draw with. Smoothing edges by multisampling then takes most of the
 * time; drawing at twice the resolution when the scene rests gives the same picture.
 */
function drawsInSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl!.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

export class Viewport {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(42, 1, 0.01, 100);
  readonly controls: OrbitControls;
  /** Called before every frame. */
  beforeFrame: () => void = () => {};

  private readonly renderer: THREE.WebGLRenderer;
  private readonly restRatio: number;
  private readonly movingRatio: number;
  private pending = false;
  readonly chooser = new DetailChooser();
  /** Drawn with the pixels of a moving scene; the first frame too, so that it comes soon. */
  private quick = true;
  private dragging = false;
  /** True while the reader turns the scene; then speed counts more than detail. */
  moving = false;
  private rest = 0;
  private cover = 0;
  private applied = "";
  private size = { width: 1, height: 1 };
  private home = { target: new THREE.Vector3(), radius: 1 };

  constructor(private readonly element: HTMLElement) {
    const software = drawsInSoftware();
    const attributes = { alpha: false, antialias: !software, depth: true, stencil: false };
    const surface = document.createElement("canvas");
    // Made here because three.js would ask for a transparent one, which costs the browser time in every frame.
    const context = surface.getContext("webgl2", attributes) as WebGL2RenderingContext | null;
    if (!context) throw new Error("no WebGL 2");
    this.renderer = new THREE.WebGLRenderer({ canvas: surface, context, ...attributes });
    this.restRatio = software ? 2 : Math.min(2, window.devicePixelRatio);
    this.movingRatio = software ? 1 : this.restRatio;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute(
      "aria-label",
      "3D scene: voxels, candidate views and the path of the scans. Arrow keys orbit, plus and minus zoom, Home resets.",
    );
    element.append(canvas);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("start", () => (this.dragging = true));
    this.controls.addEventListener("end", () => (this.dragging = false));
    this.controls.addEventListener("change", () => (this.dragging ? this.onMove() : this.requestFrame()));
    canvas.addEventListener("keydown", (event) => this.onKey(event));
    canvas.addEventListener("webglcontextrestored", () => this.requestFrame());
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#707078", 2.2));
    const sun = new THREE.DirectionalLight("#ffffff", 1.6);
    sun.position.set(-0.35, -0.55, 0.75);
    this.scene.add(sun);
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  /** Nothing more will be drawn until something changes. */
  get resting(): boolean {
    return !this.pending && !this.moving && !this.quick;
  }

  /** How the voxels are to be drawn: 0 as faces, else as points of so many voxels per side. */
  get block(): number {
    return this.moving ? this.chooser.detail.block : 0;
  }

  /** Rows of pixels that are drawn. */
  get rows(): number {
    return this.renderer.domElement.height;
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  setBackground(color: string): void {
    this.renderer.setClearColor(color);
    this.requestFrame();
  }

  /** Looks at `target` from the front, upper left, so that a ball of `radius` fits. */
  frame(target: THREE.Vector3, radius: number): void {
    this.home = { target, radius };
    this.goHome();
  }

  goHome(): void {
    const { target, radius } = this.home;
    const narrow = Math.min(1, (this.size.width - this.cover) / this.size.height);
    const distance = radius / Math.sin(THREE.MathUtils.degToRad(this.camera.fov / 2)) / Math.max(0.5, narrow);
    const direction = new THREE.Vector3(0.5, -0.95, 0.55).normalize();
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.controls.target.copy(target);
    this.camera.near = distance / 200;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.requestFrame();
  }

  /** Turns about the target by angles in radians, and moves closer (`zoom` < 1) or away. */
  orbit(azimuth: number, elevation: number, zoom = 1): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const s = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    s.theta += azimuth;
    s.phi = THREE.MathUtils.clamp(s.phi - elevation, 0.02, Math.PI - 0.02);
    s.radius *= zoom;
    const p = new THREE.Vector3().setFromSpherical(s);
    this.camera.position.set(p.x, -p.z, p.y).add(this.controls.target);
    this.controls.update();
    this.onMove();
  }

  /** Pixels at the left that something else covers: the scene is centred in what is left. */
  setCover(left: number): void {
    if (left === this.cover) return;
    this.cover = left;
    this.resize();
  }

  requestFrame(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.draw();
    });
  }

  /** Where a point of the world is on the canvas, in CSS pixels; null behind the camera. */
  project(point: THREE.Vector3): { x: number; y: number; depth: number } | null {
    const p = point.clone().project(this.camera);
    if (p.z > 1 || p.z < -1) return null;
    const depth = point.distanceTo(this.camera.position);
    return { x: ((p.x + 1) / 2) * this.size.width, y: ((1 - p.y) / 2) * this.size.height, depth };
  }

  /** The ray through a point of the canvas, in CSS pixels. */
  ray(x: number, y: number): THREE.Ray {
    const caster = new THREE.Raycaster();
    const at = new THREE.Vector2((2 * x) / this.size.width - 1, 1 - (2 * y) / this.size.height);
    this.camera.updateMatrixWorld();
    caster.setFromCamera(at, this.camera);
    return caster.ray;
  }

  /** Draws the first frame, and a sharp one when there is time. */
  drawFirst(): void {
    this.drawNow();
    this.rest = window.setTimeout(() => {
      this.quick = false;
      this.applySize();
      this.requestFrame();
    }, 250);
  }

  /** Draws now and waits until the pixels exist; returns the milliseconds that took. */
  drawNow(): number {
    const start = performance.now();
    this.camera.updateMatrixWorld();
    this.beforeFrame();
    this.renderer.render(this.scene, this.camera);
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - start;
  }

  private draw(): void {
    const time = this.moving ? this.drawNow() : (this.beforeFrame(), this.renderer.render(this.scene, this.camera), 0);
    if (this.moving && this.chooser.frame(time)) this.applySize();
  }

  private onMove(): void {
    this.moving = true;
    window.clearTimeout(this.rest);
    this.rest = window.setTimeout(() => {
      this.moving = this.quick = false;
      this.chooser.rest();
      this.applySize();
      this.requestFrame();
    }, 180);
    if (!this.quick) {
      this.quick = true;
      this.applySize();
    }
    this.requestFrame();
  }

  private applySize(): void {
    const ratio = this.quick ? this.movingRatio * this.chooser.detail.pixels : this.restRatio;
    const wanted = `${this.size.width} ${this.size.height} ${ratio}`;
    if (wanted === this.applied) return;
    this.applied = wanted;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(this.size.width, this.size.height);
  }

  private resize(): void {
    this.size = { width: Math.max(1, this.element.clientWidth), height: Math.max(1, this.element.clientHeight) };
    const { width, height } = this.size;
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, -this.cover / 2, 0, width, height);
    this.applySize();
    this.requestFrame();
  }

  private onKey(event: KeyboardEvent): void {
    const turns = new Map<string, () => void>(Object.entries({
      ArrowLeft: () => this.orbit(-0.1, 0),
      ArrowRight: () => this.orbit(0.1, 0),
      ArrowUp: () => this.orbit(0, 0.1),
      ArrowDown: () => this.orbit(0, -0.1),
      "+": () => this.orbit(0, 0, 0.9),
      "=": () => this.orbit(0, 0, 0.9),
      "-": () => this.orbit(0, 0, 1.1),
      Home: () => this.goHome(),
    }));
    const turn = turns.get(event.key);
    if (!turn || event.ctrlKey || event.metaKey || event.altKey) return;
    turn();
    event.preventDefault();
    event.stopPropagation();
  }
}

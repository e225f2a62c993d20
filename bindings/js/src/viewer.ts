// SPDX-License-Identifier: Apache-2.0
import {
  ACESFilmicToneMapping, Box3, CircleGeometry, Color, DirectionalLight, Mesh, MeshStandardMaterial, PCFSoftShadowMap,
  PerspectiveCamera, PMREMGenerator, Scene, ShadowMaterial, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import type { SacMesh } from './mesh.js';

/** A stage for one mesh: light, ground, a camera that orbits and goes along with what walks away. */
export class SacViewer {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(35, 1, 0.01, 100);
  readonly renderer: WebGLRenderer;
  readonly controls: OrbitControls;
  /** Whether the camera goes along. */
  follow = true;
  /** Milliseconds of the page's thread for the last picture. */
  renderMs = 0;
  /** Set it where what is shown has changed otherwise, such as a colour. */
  dirty = true;
  /** Called each time that the screen is drawn anew. */
  onRender: (() => void) | null = null;

  private mesh: SacMesh | null = null;
  private readonly ground = new Mesh(new CircleGeometry(1, 64), new ShadowMaterial({ opacity: 0.28 }));
  private readonly sun = new DirectionalLight(0xffffff, 2.2);
  private readonly resized: ResizeObserver;
  private readonly center = new Vector3();
  private size = 1;
  private disposed = false;

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFSoftShadowMap;
    const generator = new PMREMGenerator(this.renderer);
    this.scene.environment = generator.fromScene(new RoomEnvironment(), 0.04).texture;
    this.scene.environmentIntensity = 0.55;
    generator.dispose();
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.normalBias = 0.02;
    this.ground.rotation.x = -Math.PI / 2;
    this.ground.receiveShadow = true;
    this.scene.add(this.sun, this.sun.target, this.ground);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.08;
    this.resized = new ResizeObserver(() => this.resize());
    this.resized.observe(canvas);
    this.renderer.setAnimationLoop(() => this.render());
  }

  /** Shows a mesh instead of the one before, which stays the caller's to dispose of. */
  show(mesh: SacMesh | null): void {
    if (this.mesh) this.scene.remove(this.mesh);
    this.dirty = true;
    this.mesh = mesh;
    if (!mesh) return;
    mesh.castShadow = mesh.receiveShadow = true;
    this.scene.add(mesh);
    // The still, and the first shape: they are near each other, but another segment's may come first.
    let framed = false;
    (mesh as unknown as { addEventListener(type: string, f: () => void): void }).addEventListener('mesh', () => {
      if (this.mesh !== mesh || framed) return;
      framed = true;
      this.frameMesh();
    });
    void mesh.ready.then(() => this.mesh === mesh && this.frameMesh(), () => undefined);
  }

  /** Looks at the whole shape. */
  frameMesh(): void {
    const box = this.mesh?.geometry.boundingBox;
    if (!box || box.isEmpty()) return;
    box.getCenter(this.center);
    this.size = Math.max(box.getSize(new Vector3()).length(), 1e-9);
    const { camera, controls, size, center } = this;
    const height = Math.tan((camera.fov * Math.PI) / 360);
    const distance = (0.56 * size) / height / Math.min(camera.aspect, 1);
    camera.near = size / 200;
    camera.far = 40 * size;
    camera.position.copy(center).add(new Vector3(0.55, 0.28, 1).normalize().multiplyScalar(distance));
    camera.updateProjectionMatrix();
    controls.target.copy(center);
    controls.minDistance = size / 20;
    controls.maxDistance = 12 * size;
    controls.update();
    this.ground.scale.setScalar(30 * size);
    this.ground.position.set(center.x, box.min.y - 1e-3 * size, center.z);
    this.light();
    this.dirty = true;
  }

  private light(): void {
    const { sun, size, center } = this;
    sun.position.copy(center).add(new Vector3(1.1, 2.2, 1.3).multiplyScalar(size));
    sun.target.position.copy(center);
    const { camera } = sun.shadow;
    camera.left = camera.bottom = -0.9 * size;
    camera.right = camera.top = 0.9 * size;
    camera.near = 0.1 * size;
    camera.far = 6 * size;
    camera.updateProjectionMatrix();
  }

  set wireframe(on: boolean) {
    const material = this.mesh?.material as MeshStandardMaterial | undefined;
    if (material) material.wireframe = on;
    this.dirty = true;
  }

  set background(color: string | null) {
    this.scene.background = color ? new Color(color) : null;
    this.dirty = true;
  }

  /** Draws where anything has changed since the last time: a clip that pauses costs nothing. */
  render(): void {
    if (this.disposed) return;
    const begin = performance.now();
    const { mesh } = this;
    const shown = mesh?.update() ?? false;
    const moves = mesh !== null && this.follow && this.goAlong(mesh.geometry.boundingBox);
    const turned = this.controls.update();
    const plays = mesh !== null && !mesh.paused && mesh.stats.shown > 0;
    if (shown || moves || turned || plays || this.dirty) {
      this.dirty = false;
      this.renderer.render(this.scene, this.camera);
      this.renderMs = performance.now() - begin;
    }
    this.onRender?.();
  }

  /** Returns whether the camera has moved by what can be seen. */
  private goAlong(box: Box3 | null): boolean {
    if (!box || box.isEmpty()) return false;
    const step = box.getCenter(new Vector3()).sub(this.center);
    // A shape that breathes in place does not shake the camera, and the ground stays level.
    step.y *= 0.02;
    if (step.length() < 1e-3 * this.size) return false;
    step.multiplyScalar(step.length() > 2 * this.size ? 1 : 0.08);
    this.center.add(step);
    this.controls.target.add(step);
    this.camera.position.add(step);
    this.ground.position.x = this.center.x;
    this.ground.position.z = this.center.z;
    this.light();
    return true;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.dirty = true;
  }

  dispose(): void {
    this.disposed = true;
    this.resized.disconnect();
    this.renderer.setAnimationLoop(null);
    this.controls.dispose();
    this.scene.environment?.dispose();
    this.ground.geometry.dispose();
    (this.ground.material as ShadowMaterial).dispose();
    this.sun.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}

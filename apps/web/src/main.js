// A solved scene to walk through. Everything is in the page.
import * as THREE from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {Glb, unpackScene} from './glb.js';
import {Light} from './light.js';
import {Panel} from './panel.js';
import {Probe} from './probe.js';
import {buildScene} from './scene.js';
import {ILLUMINANCE, LINEAR, PICTURE, uniforms} from './shading.js';
import {Walk} from './walk.js';

function say(message) {
  const box = document.getElementById('message');
  box.textContent = message;
  box.hidden = false;
}

/** #camera=NAME or number, mode=orbit, ev=7, lux=500, panel=off, group0=0.5, probe=0.5,0.5: joined by & */
const link = new URLSearchParams(location.hash.slice(1));

class Viewer {
  constructor(glb) {
    this.glb = glb;
    this.about = glb.json.asset.extras.atrium;
    this.light = new Light(this.about);
    this.canvas = document.getElementById('view');
    this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, antialias: true});
    // Shaders write values of the display themselves.
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.02, 1000);
    this.cube = new THREE.WebGLCubeRenderTarget(256, {
      type: THREE.HalfFloatType, generateMipmaps: true, minFilter: THREE.LinearMipmapLinearFilter,
    });
    this.dirty = true;
  }

  async start() {
    Object.assign(this, await buildScene(this.glb, this.light, this.cube.texture));
    const size = this.box.getSize(new THREE.Vector3()).length() || 1;
    this.camera.far = 8 * size + 8;
    this.walk = new Walk(this.camera, this.canvas, () => this.redraw());
    this.orbit = new OrbitControls(this.camera, this.canvas);
    this.orbit.addEventListener('change', () => this.redraw());
    this.probe = new Probe(this.renderer);
    this.#makePanel();
    addEventListener('resize', () => this.#resize());
    this.canvas.addEventListener('pointermove', (e) => { this.pointer = e; this.redraw(); });
    this.#resize();
    this.#showCamera(this.#linkedCamera());
    this.#drawSurroundings();
    this.#followLink();
    this.last = performance.now();
    this.renderer.setAnimationLoop((now) => this.#frame(now));
  }

  redraw() { this.dirty = true; }

  #makePanel() {
    const top = Math.max(1, this.light.luxPercentile(0.95));
    this.panel = new Panel({
      camera: (i) => this.#showCamera(i),
      walk: () => this.#setWalking(true),
      orbit: () => this.#setWalking(false),
      exposure: (ev) => { uniforms.white.value = 1.2 * 2 ** ev; this.redraw(); },
      illuminance: (on) => this.#setIlluminance(on),
      top: (lux) => { uniforms.top.value = lux; this.redraw(); },
      group: (i, factor) => this.#dim(i, factor),
    }, {ev: this.about.exposure_ev, top, cameras: this.cameras, groups: this.light.groups});
    this.panel.setExposure(Number(link.get('ev') ?? this.about.exposure_ev));
    this.panel.setTop(Number(link.get('lux') ?? top));
    this.panel.setIlluminance(link.has('lux'));
    if (link.get('panel') === 'off') this.panel.hide();
  }

  #linkedCamera() {
    const asked = link.get('camera') ?? '0';
    const named = this.cameras.findIndex((c) => c.name === asked);
    return named >= 0 ? named : Number(asked) || 0;
  }

  #followLink() {
    this.light.groups.forEach((_, i) => {
      if (link.has(`group${i}`)) this.panel.setGroup(i, Number(link.get(`group${i}`)));
    });
    if (link.get('mode') === 'orbit') this.#setWalking(false);
    if (!link.has('probe')) return;
    const [x, y] = link.get('probe').split(',').map(Number);
    this.panel.showReading(this.probe.read(this.scene, this.camera, this.panes, x, y));
  }

  #showCamera(i) {
    const view = this.cameras[i];
    if (view) {
      view.matrix.decompose(this.camera.position, this.camera.quaternion, new THREE.Vector3());
      this.camera.fov = view.yfov * 180 / Math.PI;
      this.panel.showCamera(i);
    } else {
      const centre = this.box.getCenter(new THREE.Vector3());
      this.camera.position.copy(centre).add(this.box.getSize(new THREE.Vector3()).multiplyScalar(0.8));
      this.camera.lookAt(centre);
    }
    this.camera.updateProjectionMatrix();
    this.#setWalking(Boolean(view));
  }

  #setWalking(walking) {
    this.orbit.enabled = !walking;
    if (walking) {
      this.walk.start();
    } else {
      this.walk.stop();
      const ahead = this.camera.getWorldDirection(new THREE.Vector3());
      this.orbit.target.copy(this.camera.position).addScaledVector(ahead, 3);
      this.orbit.update();
    }
    this.panel.showMode(walking);
    this.redraw();
  }

  #setIlluminance(on) {
    uniforms.mode.value = on ? ILLUMINANCE : PICTURE;
    for (const pane of this.panes) pane.visible = !on;
    this.redraw();
  }

  #dim(group, factor) {
    this.light.groups[group].factor = factor;
    this.light.mixAll();
    for (const mesh of this.scene.children)
      if (mesh.geometry?.attributes.light) mesh.geometry.attributes.light.needsUpdate = true;
    this.#drawSurroundings();
    this.redraw();
  }

  /** What metals show. */
  #drawSurroundings() {
    const metals = this.scene.children.filter((m) => m.material?.uniforms?.cube);
    if (metals.length === 0) return;
    const eye = new THREE.CubeCamera(0.02, this.camera.far, this.cube);
    eye.position.copy(this.cameras.length ? this.camera.position : this.box.getCenter(new THREE.Vector3()));
    const mode = uniforms.mode.value;
    uniforms.mode.value = LINEAR;
    for (const mesh of [...metals, ...this.panes]) mesh.visible = false;
    eye.update(this.renderer, this.scene);
    for (const mesh of [...metals, ...this.panes]) mesh.visible = true;
    uniforms.mode.value = mode;
  }

  #resize() {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(innerWidth, innerHeight, false);
    this.camera.aspect = innerWidth / innerHeight;
    this.camera.updateProjectionMatrix();
    this.redraw();
  }

  #frame(now) {
    const seconds = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (this.walk.step(seconds)) this.redraw();
    if (this.orbit.enabled) this.orbit.update();
    if (!this.dirty) return;
    this.dirty = false;
    this.renderer.render(this.scene, this.camera);
    if (this.pointer)
      this.panel.showReading(this.probe.read(this.scene, this.camera, this.panes,
          this.pointer.clientX / innerWidth, this.pointer.clientY / innerHeight));
  }
}

async function main() {
  if (typeof DecompressionStream === 'undefined') return say('This browser is too old: it cannot unpack the scene.');
  const data = document.getElementById('scene');
  const glb = new Glb(await unpackScene(data.textContent));
  data.remove();
  let viewer;
  try {
    viewer = new Viewer(glb);
  } catch (error) {
    return say(`No WebGL 2 in this browser: ${error.message}`);
  }
  await viewer.start();
  document.body.dataset.ready = 'yes';
}

main().catch((error) => say(`The scene cannot be shown: ${error.message}`));

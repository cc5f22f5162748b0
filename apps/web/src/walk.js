// Walking: drag looks, keys and two fingers go.
import * as THREE from 'three';

const KEYS = {
  KeyW: [0, 0, -1], ArrowUp: [0, 0, -1], KeyS: [0, 0, 1], ArrowDown: [0, 0, 1], KeyA: [-1, 0, 0], ArrowLeft: [-1, 0, 0],
  KeyD: [1, 0, 0], ArrowRight: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
};
const SPEED = 1.6;  // m/s
const STEEPEST = 1.55;  // rad

export class Walk {
  constructor(camera, element, changed) {
    this.camera = camera;
    this.element = element;
    this.changed = changed;
    this.enabled = false;
    this.down = new Set();
    this.pointers = new Map();
    element.addEventListener('pointerdown', (e) => this.#pointerDown(e));
    element.addEventListener('pointermove', (e) => this.#pointerMove(e));
    for (const name of ['pointerup', 'pointercancel'])
      element.addEventListener(name, (e) => this.pointers.delete(e.pointerId));
    addEventListener('keydown', (e) => this.#key(e, true));
    addEventListener('keyup', (e) => this.#key(e, false));
    addEventListener('blur', () => this.down.clear());
  }

  /** Takes the camera's direction, without roll. */
  start() {
    this.enabled = true;
    const d = this.camera.getWorldDirection(new THREE.Vector3());
    this.yaw = Math.atan2(-d.x, -d.z);
    this.pitch = Math.asin(THREE.MathUtils.clamp(d.y, -1, 1));
    this.#turn();
  }
  stop() {
    this.enabled = false;
    this.down.clear();
  }

  /** @returns whether anything moved. */
  step(seconds) {
    if (!this.enabled || this.down.size === 0) return false;
    const move = new THREE.Vector3();
    for (const code of this.down) if (KEYS[code]) move.add(new THREE.Vector3(...KEYS[code]));
    const run = this.down.has('ShiftLeft') || this.down.has('ShiftRight') ? 3 : 1;
    this.#go(move.multiplyScalar(SPEED * run * seconds));
    return true;
  }

  #turn() {
    this.camera.quaternion.setFromEuler(new THREE.Euler(this.pitch, this.yaw, 0, 'YXZ'));
    this.changed();
  }
  /** Along the floor, whatever the eyes look at. */
  #go(move) {
    this.camera.position.add(move.applyAxisAngle(new THREE.Vector3(0, 1, 0), this.yaw));
    this.changed();
  }
  #key(event, down) {
    if (!this.enabled || event.target.tagName === 'INPUT' || event.target.tagName === 'SELECT') return;
    if (!KEYS[event.code] && !event.code.startsWith('Shift')) return;
    down ? this.down.add(event.code) : this.down.delete(event.code);
    if (KEYS[event.code]) event.preventDefault();
    this.changed();
  }
  #pointerDown(event) {
    if (!this.enabled) return;
    this.element.focus();
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }
  #pointerMove(event) {
    const last = this.pointers.get(event.pointerId);
    if (!this.enabled || !last) return;
    const dx = event.clientX - last[0], dy = event.clientY - last[1];
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.pointers.size > 1) {
      this.#go(new THREE.Vector3(-dx, 0, -dy).multiplyScalar(0.005));
    } else {
      const angle = this.camera.fov * Math.PI / 180 / this.element.clientHeight;
      this.yaw += dx * angle;
      this.pitch = THREE.MathUtils.clamp(this.pitch + dy * angle, -STEEPEST, STEEPEST);
      this.#turn();
    }
  }
}

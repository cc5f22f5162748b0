// Illuminance under a place of the window: one pixel is drawn with it as its colour.
import * as THREE from 'three';
import {PROBE, uniforms} from './shading.js';

export class Probe {
  constructor(renderer) {
    this.renderer = renderer;
    this.target = new THREE.WebGLRenderTarget(1, 1);
    this.pixel = new Uint8Array(4);
  }

  /** @param x, y  shares of the window, from its top left. @returns lux, or undefined: no reading. */
  read(scene, camera, hidden, x, y) {
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    camera.setViewOffset(size.x, size.y, Math.floor(x * size.x), Math.floor(y * size.y), 1, 1);
    const mode = uniforms.mode.value;
    const background = scene.background;
    uniforms.mode.value = PROBE;
    scene.background = null;
    for (const mesh of hidden) mesh.visible = false;
    this.renderer.setRenderTarget(this.target);
    this.renderer.setClearColor(0, 1);
    this.renderer.clear();
    this.renderer.render(scene, camera);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, this.pixel);
    this.renderer.setRenderTarget(null);
    for (const mesh of hidden) mesh.visible = mode === 0;
    scene.background = background;
    uniforms.mode.value = mode;
    camera.clearViewOffset();
    if (this.pixel[2] === 0) return undefined;
    return 2 ** ((this.pixel[0] * 256 + this.pixel[1]) / 65535 * 32) - 1;
  }
}

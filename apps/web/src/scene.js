// Makes a three.js scene of the file.
import * as THREE from 'three';
import {glass, metal, unlit} from './shading.js';

const WRAP = {33071: THREE.ClampToEdgeWrapping, 33648: THREE.MirroredRepeatWrapping, 10497: THREE.RepeatWrapping};

async function loadTexture(glb, index) {
  const texture = glb.json.textures[index];
  const image = glb.json.images[texture.source];
  const sampler = glb.json.samplers[texture.sampler];
  const blob = new Blob([glb.bytes(image.bufferView)], {type: image.mimeType});
  const bitmap = await createImageBitmap(blob, {premultiplyAlpha: 'none', colorSpaceConversion: 'none'});
  const out = new THREE.Texture(bitmap);
  out.flipY = false;
  out.colorSpace = THREE.SRGBColorSpace;
  out.wrapS = WRAP[sampler.wrapS];
  out.wrapT = WRAP[sampler.wrapT];
  out.anisotropy = 8;
  out.needsUpdate = true;
  return out;
}

function geometryOf(glb, primitive, light) {
  const geometry = new THREE.BufferGeometry();
  const set = (name, accessor) => {
    const {array, components, stride} = glb.numbers(accessor);
    geometry.setAttribute(name, stride === components
        ? new THREE.BufferAttribute(array, components)
        : new THREE.InterleavedBufferAttribute(new THREE.InterleavedBuffer(padded(array, stride), stride), components, 0));
  };
  const a = primitive.attributes;
  set('position', a.POSITION);
  if (a.NORMAL !== undefined) set('normal', a.NORMAL);
  if (a.TEXCOORD_0 !== undefined) set('uv', a.TEXCOORD_0);
  geometry.setIndex(new THREE.BufferAttribute(glb.numbers(primitive.indices).array, 1));
  if (a._LIGHT_0 !== undefined) {
    const codes = light.groups.map((_, g) => glb.numbers(a[`_LIGHT_${g}`]).array);
    geometry.setAttribute('light', new THREE.BufferAttribute(light.add(codes), 4));
  }
  return geometry;
}

/** Interleaved buffers hold whole elements, the last one too. */
function padded(array, stride) {
  if (array.length % stride === 0) return array;
  const out = new array.constructor(Math.ceil(array.length / stride) * stride);
  out.set(array);
  return out;
}

async function materialOf(glb, index, cube) {
  const m = glb.json.materials[index];
  const pbr = m.pbrMetallicRoughness ?? {};
  const colour = (pbr.baseColorFactor ?? [1, 1, 1]).slice(0, 3);
  if (m.extensions?.KHR_materials_transmission) return glass(colour);
  if (pbr.metallicFactor === 1 || (pbr.metallicFactor === undefined && !m.extensions?.KHR_materials_unlit))
    return metal({colour: new THREE.Vector3(...colour), roughness: pbr.roughnessFactor ?? 1, cube});
  const texture = pbr.baseColorTexture;
  return unlit({
    map: texture && await loadTexture(glb, texture.index),
    cutoff: m.alphaMode === 'MASK' ? m.alphaCutoff ?? 0.5 : 0,
    doubleSided: m.doubleSided ?? false,
    reads: m.name !== 'plain',
  });
}

function cameraOf(node, source) {
  const matrix = new THREE.Matrix4().fromArray(node.matrix);
  return {name: node.name ?? '', matrix, yfov: source.perspective?.yfov ?? 0.9};
}

/** {scene, panes, cameras, box}. Metals see `cube`; the box is without the sky. */
export async function buildScene(glb, light, cube) {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0);
  const panes = [];
  const cameras = [];
  const box = new THREE.Box3();
  const materials = await Promise.all((glb.json.materials ?? []).map((_, i) => materialOf(glb, i, cube)));
  for (const node of glb.json.nodes) {
    if (node.camera !== undefined) cameras.push(cameraOf(node, glb.json.cameras[node.camera]));
    if (node.mesh === undefined) continue;
    for (const primitive of glb.json.meshes[node.mesh].primitives) {
      const mesh = new THREE.Mesh(geometryOf(glb, primitive, light), materials[primitive.material]);
      mesh.position.fromArray(node.translation ?? [0, 0, 0]);
      mesh.scale.fromArray(node.scale ?? [1, 1, 1]);
      mesh.updateMatrixWorld();
      if (materials[primitive.material].isMeshBasicMaterial) panes.push(mesh);
      if (node.name !== 'sky') box.expandByObject(mesh);
      scene.add(mesh);
    }
  }
  return {scene, panes, cameras, box};
}

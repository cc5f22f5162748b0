// How surfaces are drawn: their own light, tone mapped as `atrium render` does, or its illuminance.
import * as THREE from 'three';
import {STOPS} from './colours.js';

export const PICTURE = 0, ILLUMINANCE = 1, PROBE = 2, LINEAR = 3;

/** Shared by all materials. */
export const uniforms = {
  mode: {value: PICTURE},
  white: {value: 1},
  top: {value: 1000},
  stops: {value: STOPS.map((c) => new THREE.Vector3(...c))},
};

const DISPLAY = `
  uniform int mode;
  uniform float white;
  uniform float top;
  uniform vec3 stops[${STOPS.length}];

  // The filmic curve and encoding of atrium's tone mapping.
  vec3 filmic(vec3 x) {
    vec3 s = 0.72317 * x;
    return min(vec3(1.0), s * (2.51 * s + 0.03) / (s * (2.43 * s + 0.59) + 0.14));
  }
  vec3 encode(vec3 v) {
    return mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, vec3(lessThanEqual(v, vec3(0.0031308))));
  }
  vec3 scaleColour(float lux) {
    float x = clamp(lux / top, 0.0, 1.0) * ${(STOPS.length - 1).toFixed(1)};
    int i = min(int(x), ${STOPS.length - 2});
    return mix(stops[i], stops[i + 1], x - float(i));
  }
  // log2(1 + lux) in 24 bits; blue is above 0 where there is a surface with a reading.
  vec4 packLux(float lux) {
    float v = clamp(log2(1.0 + lux) / 32.0, 0.0, 1.0) * 65535.0;
    return vec4(floor(v / 256.0) / 255.0, mod(floor(v), 256.0) / 255.0, 1.0, 1.0);
  }
  vec4 show(vec3 radiance, float lux) {
    if (mode == ${LINEAR}) return vec4(radiance, 1.0);
    if (mode == ${PROBE}) return lux < 0.0 ? vec4(0.0, 0.0, 0.0, 1.0) : packLux(lux);
    if (mode == ${ILLUMINANCE}) return vec4(lux < 0.0 ? vec3(0.12) : scaleColour(lux), 1.0);
    return vec4(encode(filmic(max(radiance, 0.0) / white)), 1.0);
  }
`;

/** Baked light times a picture. @param reads  has the surface an illuminance? */
export function unlit({map, cutoff, doubleSided, reads}) {
  const defines = {};
  if (map) defines.MAP = '';
  if (cutoff > 0) defines.CUTOFF = cutoff.toFixed(4);
  if (reads) defines.READS = '';
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    defines,
    side: doubleSided ? THREE.DoubleSide : THREE.FrontSide,
    uniforms: {...uniforms, map: {value: map ?? null}},
    vertexShader: `
      in vec4 light;
      out vec4 vLight;
      out vec2 vUv;
      void main() {
        vLight = light;
        #ifdef MAP
          vUv = uv;
        #endif
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `
      ${DISPLAY}
      uniform sampler2D map;
      in vec4 vLight;
      in vec2 vUv;
      out vec4 colour;
      void main() {
        vec3 radiance = vLight.rgb;
        #ifdef MAP
          vec4 texel = texture(map, vUv);
          #ifdef CUTOFF
            if (texel.a < CUTOFF) discard;
          #endif
          radiance *= texel.rgb;
        #endif
        #ifdef READS
          colour = show(radiance, vLight.a);
        #else
          colour = show(radiance, -1.0);
        #endif
      }`,
  });
}

/** A mirror that shows a cube of pictures taken somewhere in the scene. */
export function metal({colour, roughness, cube}) {
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    side: THREE.DoubleSide,
    uniforms: {...uniforms, cube: {value: cube}, colour: {value: colour}, level: {value: 7 * Math.sqrt(roughness)}},
    vertexShader: `
      out vec3 vNormal;
      out vec3 vPosition;
      void main() {
        vec4 p = modelMatrix * vec4(position, 1.0);
        vNormal = mat3(modelMatrix) * normal;
        vPosition = p.xyz;
        gl_Position = projectionMatrix * viewMatrix * p;
      }`,
    fragmentShader: `
      ${DISPLAY}
      uniform samplerCube cube;
      uniform vec3 colour;
      uniform float level;
      in vec3 vNormal;
      in vec3 vPosition;
      out vec4 result;
      void main() {
        vec3 r = reflect(normalize(vPosition - cameraPosition), normalize(vNormal));
        result = show(colour * textureLod(cube, vec3(-r.x, r.yz), level).rgb, -1.0);
      }`,
  });
}

/** Glass takes its share of what is behind it. */
export function glass(colour) {
  const shown = colour.map((v) => v ** (1 / 2.2));  // of values that are encoded already
  return new THREE.MeshBasicMaterial({
    color: new THREE.Color().setRGB(...shown, THREE.LinearSRGBColorSpace),
    blending: THREE.CustomBlending,
    blendSrc: THREE.ZeroFactor,
    blendDst: THREE.SrcColorFactor,
    transparent: true,
    depthWrite: false,
    side: THREE.DoubleSide,
    toneMapped: false,
  });
}

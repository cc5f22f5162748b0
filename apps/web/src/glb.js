// Reads the binary glTF that the program wrote into the page.

const ARRAYS = {5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array};
const COMPONENTS = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4};

/** The page's own data: base64 of a gzipped file. */
export async function unpackScene(text) {
  const packed = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

export class Glb {
  constructor(buffer) {
    const view = new DataView(buffer);
    const length = view.getUint32(12, true);
    this.json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
    this.buffer = buffer;
    this.start = 20 + length + 8;
  }

  /** Bytes of a buffer view. */
  bytes(index) {
    const view = this.json.bufferViews[index];
    return new Uint8Array(this.buffer, this.start + (view.byteOffset ?? 0), view.byteLength);
  }

  /** {array, components, stride}: numbers of an accessor; stride in numbers. */
  numbers(index) {
    const accessor = this.json.accessors[index];
    const view = this.json.bufferViews[accessor.bufferView];
    const type = ARRAYS[accessor.componentType];
    const components = COMPONENTS[accessor.type];
    const stride = view.byteStride ? view.byteStride / type.BYTES_PER_ELEMENT : components;
    const at = this.start + (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    return {array: new type(this.buffer, at, (accessor.count - 1) * stride + components), components, stride,
            count: accessor.count};
  }
}

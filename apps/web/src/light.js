// Light of the vertices: logarithmic 16-bit codes by group, mixed by the sliders.

/** Values of all codes; the low four bits say nothing. */
function table(largest, steps, octaves) {
  const values = new Float32Array(4096);
  for (let i = 1; i < 4096; ++i) values[i] = largest * 2 ** ((i / steps - 1) * octaves);
  return values;
}

export class Light {
  /** @param about  asset.extras.atrium of the file */
  constructor(about) {
    this.groups = about.groups.map((g) => ({
      name: g.name,
      factor: 1,
      radiance: table(g.largest_radiance, about.steps, about.octaves),
      lux: table(g.largest_lux, about.steps, about.octaves),
    }));
    this.parts = [];
  }

  /** @param codes  by group, four numbers a vertex. @returns their mixture, to be kept. */
  add(codes) {
    const mixed = new Float32Array(codes[0].length);
    const part = {codes, mixed};
    this.parts.push(part);
    this.#mix(part);
    return mixed;
  }

  /** Fills all mixtures anew after a factor has changed. */
  mixAll() {
    for (const part of this.parts) this.#mix(part);
  }

  #mix({codes, mixed}) {
    mixed.fill(0);
    this.groups.forEach(({factor, radiance, lux}, g) => {
      if (factor === 0) return;
      const code = codes[g];
      for (let i = 0; i < code.length; i += 4) {
        mixed[i] += factor * radiance[code[i] >> 4];
        mixed[i + 1] += factor * radiance[code[i + 1] >> 4];
        mixed[i + 2] += factor * radiance[code[i + 2] >> 4];
        mixed[i + 3] += factor * lux[code[i + 3] >> 4];
      }
    });
  }

  /** A value that few vertices exceed. */
  luxPercentile(share) {
    const sample = [];
    for (const {mixed} of this.parts) {
      const step = 4 * Math.max(1, Math.floor(mixed.length / 4 / 5000));
      for (let i = 3; i < mixed.length; i += step) if (mixed[i] > 0) sample.push(mixed[i]);
    }
    sample.sort((a, b) => a - b);
    return sample.length ? sample[Math.min(sample.length - 1, Math.floor(share * sample.length))] : 0;
  }
}

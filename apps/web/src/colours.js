// Colours of the illuminance scale: viridis, dark to light, told apart by all eyes.
export const STOPS = [
  [0.267, 0.005, 0.329], [0.283, 0.141, 0.458], [0.254, 0.265, 0.530], [0.207, 0.372, 0.553],
  [0.164, 0.471, 0.558], [0.128, 0.567, 0.551], [0.135, 0.659, 0.518], [0.267, 0.749, 0.441],
  [0.478, 0.821, 0.318], [0.741, 0.873, 0.150], [0.993, 0.906, 0.144],
];

export function cssGradient() {
  const colours = STOPS.map((c) => `rgb(${c.map((v) => Math.round(255 * v)).join(' ')})`);
  return `linear-gradient(to right, ${colours.join(', ')})`;
}

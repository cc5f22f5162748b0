// The panel beside the view.
import {cssGradient} from './colours.js';

const $ = (id) => document.getElementById(id);

/** Three digits, for people. */
export function figure(value) {
  if (value >= 1000) return Math.round(Number(value.toPrecision(3))).toLocaleString('en');
  return String(Number(value.toPrecision(3)));
}

export class Panel {
  /** @param act  {camera(i), walk(), orbit(), exposure(ev), illuminance(on), top(lux), group(i, factor)} */
  constructor(act, {ev, top, cameras, groups}) {
    this.act = act;
    cameras.forEach((c, i) => $('cameras').add(new Option(c.name || `Camera ${i}`, String(i))));
    $('cameras').hidden = cameras.length === 0;
    $('cameras').onchange = () => act.camera(Number($('cameras').value));
    $('walk').onclick = () => act.walk();
    $('orbit').onclick = () => act.orbit();
    $('exposure').min = String(ev - 8);
    $('exposure').max = String(ev + 8);
    $('exposure').oninput = () => this.setExposure(Number($('exposure').value));
    $('bar').style.background = cssGradient();
    $('false-colour').onchange = () => this.setIlluminance($('false-colour').checked);
    const octave = Math.log2(Math.max(top, 1));
    $('top').min = String(octave - 6);
    $('top').max = String(octave + 6);
    $('top').oninput = () => this.setTop(2 ** Number($('top').value));
    if (groups.length > 1) groups.forEach((g, i) => this.#addGroup(g.name, i));
  }

  setExposure(ev) {
    $('exposure').value = String(ev);
    $('exposure-text').value = `EV ${ev.toFixed(1)}`;
    this.act.exposure(ev);
  }
  setIlluminance(on) {
    $('false-colour').checked = on;
    $('scale').hidden = !on;
    this.act.illuminance(on);
  }
  /** Rounded to two digits, as the scale says. */
  setTop(lux) {
    const top = Number(lux.toPrecision(2));
    $('top').value = String(Math.log2(top));
    $('top-text').value = `${figure(top)} lx`;
    $('ticks').replaceChildren(...[0, 0.25, 0.5, 0.75, 1].map((share) => {
      const tick = document.createElement('span');
      tick.textContent = figure(share * top);
      return tick;
    }));
    this.act.top(top);
  }
  showMode(walking) {
    $('walk').classList.toggle('on', walking);
    $('orbit').classList.toggle('on', !walking);
  }
  showCamera(i) { $('cameras').value = String(i); }
  showReading(lux) { $('readout').textContent = lux === undefined ? '\u00a0' : `${figure(lux)} lx`; }
  hide() { $('panel').classList.add('off'); }

  setGroup(i, factor) {
    const [, slider, out] = $('groups').children[i]?.children ?? [];
    if (slider) {
      slider.value = String(factor);
      out.value = `${Math.round(100 * factor)} %`;
    }
    this.act.group(i, factor);
  }

  #addGroup(name, i) {
    const row = document.createElement('label');
    row.className = 'row';
    const text = document.createElement('span');
    text.textContent = name;
    const slider = Object.assign(document.createElement('input'), {type: 'range', min: '0', max: '2', step: '0.02', value: '1'});
    const out = document.createElement('output');
    out.value = '100 %';
    slider.oninput = () => this.setGroup(i, Number(slider.value));
    row.append(text, slider, out);
    $('groups').append(row);
  }
}

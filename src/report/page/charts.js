'use strict';
// Charts over time as SVG, drawn anew for each width; a cursor in time is common to all of them.

function svgElement(name, attributes, text) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes || {})) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

function formatNumber(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '-';
  const magnitude = Math.abs(value);
  if (magnitude !== 0 && (magnitude >= 1e6 || magnitude < 1e-4)) return value.toExponential(2);
  const decimals = magnitude === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(magnitude)));
  return value.toLocaleString('en', { minimumFractionDigits: Math.min(decimals, 6), maximumFractionDigits: Math.min(decimals, 6) });
}

// About `count` round numbers from low to high.
function roundTicks(low, high, count) {
  const rough = Math.max(high - low, 1e-12) / count;
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999) * power;
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push(i * step);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return ticks.map((value) => ({ value, label: (Math.abs(value) < step / 2 ? 0 : value).toFixed(Math.min(decimals, 6)) }));
}

// The time [s] that the mouse points at, or null; every chart and view listens.
class TimeCursor {
  constructor() { this.listeners = new Map(); }
  listen(host, listener) { this.listeners.set(host, listener); }  // one for each element, the last
  set(time) { for (const listener of this.listeners.values()) listener(time); }
}

// Index of the value nearest to `time` in ascending `times`, or -1.
function nearestIndex(times, time) {
  let low = 0;
  let high = times.length - 1;
  if (high < 0) return -1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle; else high = middle;
  }
  return time - times[low] <= times[high] - time ? low : high;
}

const tooltip = {
  show(event, text) {
    const box = document.getElementById('tooltip');
    box.textContent = text;
    box.hidden = false;
    const width = box.offsetWidth;
    const left = event.clientX + 14 + width > window.innerWidth ? event.clientX - width - 14 : event.clientX + 14;
    box.style.left = Math.max(4, left) + 'px';
    box.style.top = Math.max(4, Math.min(event.clientY + 14, window.innerHeight - box.offsetHeight - 4)) + 'px';
  },
  hide() { document.getElementById('tooltip').hidden = true; }
};

// entries: [{name, colour (CSS), kind: '' | 'line' | 'dot'}]
function drawLegend(host, entries) {
  host.className = 'legend';
  host.replaceChildren(...entries.map((entry) => {
    const item = document.createElement('span');
    item.textContent = entry.name;
    item.className = entry.kind || '';
    item.style.setProperty('--swatch', entry.colour);
    return item;
  }));
}

// Calls draw(width) now and whenever the width of `host` changes.
function drawAtEachWidth(host, draw) {
  let last = 0;
  const redraw = () => {
    const width = Math.floor(host.clientWidth);
    if (width > 0 && width !== last) { last = width; draw(width); }
  };
  redraw();
  new ResizeObserver(redraw).observe(host);
}

// A chart over time. options: {height, from, to [s], low, high, unit, label (of the whole, for screen readers), cursor, describe(time) -> text,
// content(svg, x, y, area): draws between the axes}. Without `unit` there is no vertical axis.
function timeChart(host, options) {
  drawAtEachWidth(host, (width) => {
    const area = { left: 52, right: width - 10, top: 14, bottom: options.height - 30 };
    const span = Math.max(options.to - options.from, 1e-9);
    const range = Math.max(options.high - options.low, 1e-12);
    const x = (time) => area.left + (time - options.from) / span * (area.right - area.left);
    const y = (value) => area.bottom - (value - options.low) / range * (area.bottom - area.top);
    const svg = svgElement('svg', { height: options.height, viewBox: `0 0 ${width} ${options.height}`, role: 'img', 'aria-label': options.label });
    if (options.unit) {
      for (const tick of roundTicks(options.low, options.high, Math.max(2, Math.floor(options.height / 45)))) {
        svg.append(svgElement('line', { x1: area.left, x2: area.right, y1: y(tick.value), y2: y(tick.value), class: 'grid' }),
          svgElement('text', { x: area.left - 6, y: y(tick.value) + 4, 'text-anchor': 'end' }, tick.label));
      }
      svg.append(svgElement('text', { x: 2, y: 8 }, options.unit));
    }
    options.content(svg, x, y, area);
    svg.append(svgElement('line', { x1: area.left, x2: area.right, y1: area.bottom, y2: area.bottom, class: 'axis' }));
    for (const tick of roundTicks(options.from, options.to, Math.max(2, Math.floor(width / 110)))) {
      svg.append(svgElement('line', { x1: x(tick.value), x2: x(tick.value), y1: area.bottom, y2: area.bottom + 4, class: 'axis' }),
        svgElement('text', { x: x(tick.value), y: area.bottom + 17, 'text-anchor': 'middle' }, tick.label + ' s'));
    }
    const mark = svgElement('line', { y1: area.top, y2: area.bottom, class: 'cursor', visibility: 'hidden' });
    svg.append(mark);
    options.cursor.listen(host, (time) => {
      const shown = time !== null && time >= options.from && time <= options.to;
      mark.setAttribute('visibility', shown ? 'visible' : 'hidden');
      if (shown) { mark.setAttribute('x1', x(time)); mark.setAttribute('x2', x(time)); }
    });
    svg.addEventListener('mousemove', (event) => {
      const time = options.from + (event.clientX - svg.getBoundingClientRect().left - area.left) / (area.right - area.left) * span;
      if (time < options.from || time > options.to) { options.cursor.set(null); tooltip.hide(); return; }
      options.cursor.set(time);
      const text = options.describe(time);
      if (text) tooltip.show(event, text); else tooltip.hide();
    });
    svg.addEventListener('mouseleave', () => { options.cursor.set(null); tooltip.hide(); });
    host.replaceChildren(svg);
  });
}

// Path through (times, values), broken where two samples lie farther apart than `gap` [s] or a value is missing.
function linePath(times, values, x, y, gap) {
  let path = '';
  let last = -Infinity;
  times.forEach((time, i) => {
    if (values[i] === null) return;
    path += (!path || time - last > gap ? 'M' : 'L') + x(time).toFixed(1) + ' ' + y(values[i]).toFixed(1);
    last = time;
  });
  return path;
}

// Areas upon each other; series[k][i] belongs to times[i].
function stackedAreas(svg, times, series, x, y) {
  const below = times.map(() => 0);
  series.forEach((values, k) => {
    const above = values.map((value, i) => below[i] + value);
    let path = '';
    times.forEach((time, i) => { path += (i ? 'L' : 'M') + x(time).toFixed(1) + ' ' + y(above[i]).toFixed(1); });
    for (let i = times.length - 1; i >= 0; --i) path += 'L' + x(times[i]).toFixed(1) + ' ' + y(below[i]).toFixed(1);
    svg.append(svgElement('path', { d: path + 'Z', style: `fill: var(--series-${k % 10})` }));
    above.forEach((value, i) => { below[i] = value; });
  });
}

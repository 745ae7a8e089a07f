'use strict';
// Small graphs of the last minute, the state as a band below each.

const GRAPH_SECONDS = 60;
const BAND_HEIGHT = 5; // [px]

const cssText = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// 1, 2 or 5 times a power of ten, at least `value`.
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-9)));
  return power * [1, 2, 5, 10].find((step) => step * power >= value - 1e-12);
}

function median(values) {
  const sorted = values.filter(Number.isFinite).sort((a, b) => a - b);
  return sorted.length ? sorted[sorted.length >> 1] : NaN;
}

// The frames' figures, by time; each {time [s], state, latency_ms, tracking_ms, tracked, mapped}.
class FrameHistory {
  constructor() { this.frames = []; this.arrived = 0; }

  add(frame) {
    const last = this.frames[this.frames.length - 1];
    if (last && frame.time < last.time) this.frames = []; // another recording, or the clock of another start
    this.frames.push(frame);
    this.arrived = performance.now();
    while (this.frames[0].time < frame.time - GRAPH_SECONDS - 2) this.frames.shift();
  }

  // Goes on where frames stay away.
  now() {
    const last = this.frames[this.frames.length - 1];
    return last ? last.time + Math.max(0, (performance.now() - this.arrived) / 1000 - 0.3) : 0;
  }

  since(seconds) { const from = this.now() - seconds; return this.frames.filter((frame) => frame.time >= from); }

  // [{time, frames, poses}] of each second.
  rates() {
    const seconds = new Map();
    const now = this.now();
    for (const frame of this.frames) {
      const age = Math.floor(now - frame.time);
      const count = seconds.get(age) || { frames: 0, poses: 0 };
      ++count.frames;
      if (isMeasured(frame.state)) ++count.poses;
      seconds.set(age, count);
    }
    const first = this.frames.length ? Math.floor(now - this.frames[0].time) : 0;
    const rates = [];
    for (let age = Math.min(first - 1, GRAPH_SECONDS - 1); age >= 0; --age) {
      rates.push({ time: now - age - 0.5, ...(seconds.get(age) || { frames: 0, poses: 0 }) });
    }
    return rates;
  }
}

const isMeasured = (state) => state === 'tracking' || state === 'recovered' || state === 'relocalised';

// `lines`: [{colour, values: [[time, value]]}].
function drawGraph(canvas, history, lines) {
  if (canvas.clientWidth === 0) return;
  const density = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * density)) Object.assign(canvas, { width: Math.round(width * density), height: Math.round(height * density) });
  const pen = canvas.getContext('2d', { willReadFrequently: true });
  pen.setTransform(density, 0, 0, density, 0, 0);
  pen.clearRect(0, 0, width, height);
  const now = history.now();
  const left = 36;
  const top = 8;
  const bottom = height - BAND_HEIGHT - 3;
  const largest = roundUp(1.02 * Math.max(1, ...lines.flatMap((line) => line.values.map((pair) => pair[1]).filter(Number.isFinite))));
  const x = (time) => width - (now - time) / GRAPH_SECONDS * (width - left);
  const y = (value) => bottom - value / largest * (bottom - top);
  pen.strokeStyle = cssText('--grid');
  pen.fillStyle = cssText('--quiet');
  pen.font = '11px system-ui, "DejaVu Sans", sans-serif';
  pen.textAlign = 'right';
  pen.textBaseline = 'middle';
  for (const value of [0, largest / 2, largest]) {
    pen.beginPath();
    pen.moveTo(left, Math.round(y(value)) + 0.5);
    pen.lineTo(width, Math.round(y(value)) + 0.5);
    pen.stroke();
    pen.fillText(String(value), left - 5, y(value));
  }
  for (const line of lines) {
    pen.strokeStyle = cssText(line.colour);
    pen.lineWidth = 1.4;
    pen.beginPath();
    let before = -Infinity;
    for (const [time, value] of line.values) {
      if (!Number.isFinite(value) || x(time) < left) continue;
      if (time - before > 1.5) pen.moveTo(x(time), y(value)); else pen.lineTo(x(time), y(value));
      before = time;
    }
    pen.stroke();
  }
  drawBand(pen, history, x, left, height);
}

function drawBand(pen, history, x, left, height) {
  const colours = {};
  const frames = history.frames;
  for (let i = 0; i < frames.length; ++i) {
    const state = frames[i].state;
    if (!(state in colours)) colours[state] = cssText('--' + state);
    const end = i + 1 < frames.length ? Math.min(frames[i + 1].time, frames[i].time + 1) : frames[i].time + 0.05;
    const from = Math.max(left, x(frames[i].time));
    if (x(end) <= left) continue;
    pen.fillStyle = colours[state];
    pen.fillRect(Math.floor(from), height - BAND_HEIGHT, Math.ceil(x(end) - from), BAND_HEIGHT); // no seams between frames
  }
}

// `elements`: canvas and value of each of latency, tracking, rate, points.
function drawGraphs(history, elements) {
  const frames = history.frames;
  const recent = history.since(2);
  const ms = (value) => (Number.isFinite(value) ? value.toFixed(1) + ' ms' : '–');
  drawGraph(elements.latency.canvas, history, [{ colour: '--first', values: frames.map((f) => [f.time, f.latency_ms]) }]);
  elements.latency.value.textContent = ms(median(recent.map((f) => f.latency_ms)));
  drawGraph(elements.tracking.canvas, history, [{ colour: '--first', values: frames.map((f) => [f.time, f.tracking_ms]) }]);
  elements.tracking.value.textContent = ms(median(recent.map((f) => f.tracking_ms)));
  const rates = history.rates();
  drawGraph(elements.rate.canvas, history, [{ colour: '--second', values: rates.map((r) => [r.time, r.frames]) }, { colour: '--first', values: rates.map((r) => [r.time, r.poses]) }]);
  const rate = rates[rates.length - 1];
  elements.rate.value.textContent = rate ? `${rate.frames}, ${rate.poses} / s` : '–';
  const counted = frames.filter((f) => f.tracked !== undefined);
  drawGraph(elements.points.canvas, history, [{ colour: '--second', values: counted.map((f) => [f.time, f.tracked]) }, { colour: '--first', values: counted.map((f) => [f.time, f.mapped]) }]);
  const last = counted[counted.length - 1];
  elements.points.value.textContent = last ? `${last.tracked}, ${last.mapped}` : '–';
}

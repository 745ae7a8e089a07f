'use strict';
// The camera's image with what tracking sees in it.

const TRACK_COLOURS = { mapped: '#2fd08a', unmapped: '#ffb000', outlier: '#ff4d7d' };
const EDGE_COLOUR = 'rgba(56, 182, 255, 0.75)';
const STEPS_A_PIXEL = 16;
const LINE_END = 0xffff;

function readPicture(description, rest) {
  const view = new DataView(rest.buffer);
  const tracks = [];
  let at = description.jpeg_bytes;
  for (let i = 0; i < description.tracks; ++i, at += 12) {
    const pixel = (offset) => view.getUint16(at + offset, true) / STEPS_A_PIXEL;
    const flags = view.getUint8(at + 10);
    tracks.push({
      x: pixel(0), y: pixel(2), fromX: pixel(4), fromY: pixel(6), normalX: view.getInt8(at + 8) / 127, normalY: view.getInt8(at + 9) / 127,
      corner: (flags & 1) !== 0, kind: flags & 4 ? 'outlier' : flags & 2 ? 'mapped' : 'unmapped',
    });
  }
  const lines = [[]];
  for (let i = 0; i < description.edge_points; ++i, at += 4) {
    const x = view.getUint16(at, true);
    if (x === LINE_END) lines.push([]);
    else lines[lines.length - 1].push(x / STEPS_A_PIXEL, view.getUint16(at + 2, true) / STEPS_A_PIXEL);
  }
  return { tracks, lines, jpeg: new Blob([rest.subarray(0, description.jpeg_bytes)], { type: 'image/jpeg' }) };
}

class PictureView {
  // `told` is called with the description of each picture that is shown.
  constructor(host, controls, told) {
    this.host = host;
    this.told = told;
    this.canvas = host.querySelector('canvas');
    this.controls = controls;
    for (const control of Object.values(controls)) control.addEventListener('input', () => this.draw());
    new ResizeObserver(() => this.draw()).observe(host);
  }

  // Where the browser is slower than the pictures come, the newest one is next.
  async show(description, rest) {
    this.next = { description, rest };
    if (this.busy) return;
    this.busy = true;
    try {
      while (this.next) {
        const { description: newest, rest: its } = this.next;
        this.next = null;
        await this.decode(newest, its);
        await new Promise((resolve) => requestAnimationFrame(() => { this.draw(); resolve(); }));
      }
    } finally {
      this.busy = false;
    }
  }

  async decode(description, rest) {
    const picture = readPicture(description, rest);
    const image = await createImageBitmap(picture.jpeg);
    if (this.image) this.image.close();
    this.image = image;
    this.picture = picture;
    this.description = description;
    this.host.querySelector('.empty').hidden = true;
    this.told(description);
  }

  draw() {
    if (!this.image) return;
    const density = window.devicePixelRatio || 1;
    const width = Math.round(this.host.clientWidth * density);
    const height = Math.round(this.host.clientHeight * density);
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    // Thousands of short lines are drawn by the processor: quick everywhere, also where the graphics are software's.
    const pen = this.canvas.getContext('2d', { willReadFrequently: true });
    pen.fillStyle = '#000';
    pen.fillRect(0, 0, width, height);
    const scale = Math.min(width / this.description.width, height / this.description.height);
    const left = (width - scale * this.description.width) / 2;
    const top = (height - scale * this.description.height) / 2;
    pen.drawImage(this.image, left, top, scale * this.description.width, scale * this.description.height);
    this.placeX = (x) => left + scale * (x + 0.5);
    this.placeY = (y) => top + scale * (y + 0.5);
    this.unit = density * Math.max(0.6, Math.min(1.4, scale / density));
    if (this.controls.edges.checked) this.drawEdges(pen);
    if (this.controls.trails.checked) this.drawTrails(pen);
    if (this.controls.tracks.checked) this.drawTracks(pen);
  }

  drawEdges(pen) {
    pen.strokeStyle = EDGE_COLOUR;
    pen.lineWidth = this.unit;
    pen.beginPath();
    for (const line of this.picture.lines) {
      for (let i = 0; i < line.length; i += 2) {
        if (i === 0) pen.moveTo(this.placeX(line[0]), this.placeY(line[1]));
        else pen.lineTo(this.placeX(line[i]), this.placeY(line[i + 1]));
      }
    }
    pen.stroke();
  }

  drawTrails(pen) {
    pen.lineWidth = this.unit;
    pen.globalAlpha = 0.7;
    for (const [kind, colour] of Object.entries(TRACK_COLOURS)) {
      pen.strokeStyle = colour;
      pen.beginPath();
      for (const track of this.picture.tracks) {
        if (track.kind !== kind) continue;
        pen.moveTo(this.placeX(track.fromX), this.placeY(track.fromY));
        pen.lineTo(this.placeX(track.x), this.placeY(track.y));
      }
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  drawTracks(pen) {
    const radius = 2.4 * this.unit;
    for (const [kind, colour] of Object.entries(TRACK_COLOURS)) {
      pen.fillStyle = colour;
      pen.beginPath();
      for (const track of this.picture.tracks) {
        if (track.kind !== kind) continue;
        const x = this.placeX(track.x);
        const y = this.placeY(track.y);
        if (track.corner) {
          pen.rect(x - radius, y - radius, 2 * radius, 2 * radius);
        } else {
          pen.moveTo(x + radius, y);
          pen.arc(x, y, radius, 0, 2 * Math.PI);
        }
      }
      pen.fill();
    }
  }
}

// A trajectory seen along one axis, with one scale for both axes of the page.

// The box around flat positions [x y z x y z ...] along axes a and b: grows `box` = {low: [a, b], high: [a, b]}.
function growBox(box, positions, a, b) {
  for (let i = 0; i + 2 < positions.length; i += 3) {
    [positions[i + a], positions[i + b]].forEach((value, k) => {
      if (value === null) return;
      box.low[k] = Math.min(box.low[k], value);
      box.high[k] = Math.max(box.high[k], value);
    });
  }
}

// run: the report's data; a, b: which axis goes right and which up. `other`, where there is one, is a second trajectory to compare with.
function planeView(host, run, a, b, label, cursor) {
  const box = { low: [Infinity, Infinity], high: [-Infinity, -Infinity] };
  growBox(box, run.trajectory.positions, a, b);
  if (run.truth) growBox(box, run.truth.positions, a, b);
  if (run.other) growBox(box, run.other.positions, a, b);
  if (!Number.isFinite(box.low[0])) {
    host.innerHTML = '<p class="notice">No frame has a pose: there is nothing to draw.</p>';
    return;
  }
  const largest = Math.max(box.high[0] - box.low[0], box.high[1] - box.low[1], 1e-6);
  const gap = Math.max(0.5, 20 * run.frame_interval_ms / 1000);

  drawAtEachWidth(host, (width) => {
    const margin = { left: 56, right: 14, top: 22, bottom: 40 };
    const inner = width - margin.left - margin.right;
    const padding = 0.06 * largest;
    const extents = [0, 1].map((k) => Math.max(box.high[k] - box.low[k], 0.3 * largest) + 2 * padding);
    const scale = Math.min(inner / extents[0], 420 / extents[1]);
    const height = Math.round(extents[1] * scale) + margin.top + margin.bottom;
    const centre = [0, 1].map((k) => (box.low[k] + box.high[k]) / 2);
    const half = [inner / 2 / scale, extents[1] / 2];
    const x = (value) => margin.left + (value - centre[0] + half[0]) * scale;
    const y = (value) => height - margin.bottom - (value - centre[1] + half[1]) * scale;
    const svg = svgElement('svg', { height, viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': label });
    const clip = 'clip-' + host.id;
    const frame = { x: margin.left, y: margin.top, width: inner, height: height - margin.top - margin.bottom };
    const clipPath = svgElement('clipPath', { id: clip });
    clipPath.append(svgElement('rect', frame));
    svg.append(clipPath);
    for (const tick of roundTicks(centre[0] - half[0], centre[0] + half[0], Math.max(3, Math.floor(inner / 80)))) {
      svg.append(svgElement('line', { x1: x(tick.value), x2: x(tick.value), y1: frame.y, y2: frame.y + frame.height, class: 'grid' }),
        svgElement('text', { x: x(tick.value), y: frame.y + frame.height + 16, 'text-anchor': 'middle' }, tick.label));
    }
    for (const tick of roundTicks(centre[1] - half[1], centre[1] + half[1], Math.max(3, Math.floor(frame.height / 60)))) {
      svg.append(svgElement('line', { x1: frame.x, x2: frame.x + inner, y1: y(tick.value), y2: y(tick.value), class: 'grid' }),
        svgElement('text', { x: frame.x - 6, y: y(tick.value) + 4, 'text-anchor': 'end' }, tick.label));
    }
    svg.append(svgElement('text', { x: frame.x + inner, y: height - 6, 'text-anchor': 'end' }, `${run.axes[a]} [${run.unit}]`),
      svgElement('text', { x: 2, y: 12 }, `${run.axes[b]} [${run.unit}]`));

    const plot = svgElement('g', { 'clip-path': `url(#${clip})` });
    const path = (series, colour, strokeWidth, dashes = 'none') => {
      if (!series) return;
      let line = '';
      series.times.forEach((time, i) => {
        const px = series.positions[3 * i + a];
        const py = series.positions[3 * i + b];
        if (px === null || py === null) return;
        const broken = i === 0 || time - series.times[i - 1] > gap;
        line += (broken || !line ? 'M' : 'L') + x(px).toFixed(1) + ' ' + y(py).toFixed(1);
      });
      plot.append(svgElement('path', { d: line, class: 'line', style: `stroke: ${colour}; stroke-width: ${strokeWidth}; stroke-dasharray: ${dashes}` }));
    };
    path(run.truth, 'var(--truth)', 4.5);
    path(run.live, 'var(--live)', 0.9);
    path(run.trajectory, 'var(--estimate)', 1.8);
    path(run.other, 'var(--live)', 1.8, '6 4');
    for (const keyframe of run.keyframes) {
      const dot = svgElement('circle', { cx: x(keyframe.position[a]), cy: y(keyframe.position[b]), r: 2.6, style: 'fill: var(--keyframe)' });
      dot.addEventListener('mousemove', (event) => {
        tooltip.show(event, `keyframe ${keyframe.id}, frame ${keyframe.frame}, ${keyframe.time.toFixed(2)} s\n${keyframe.reason}`);
        cursor.set(keyframe.time);
      });
      dot.addEventListener('mouseleave', () => { tooltip.hide(); cursor.set(null); });
      plot.append(dot);
    }
    const mark = svgElement('circle', { r: 5, class: 'cursor-dot', visibility: 'hidden' });
    cursor.listen(host, (time) => {
      const i = time === null ? -1 : nearestIndex(run.trajectory.times, time);
      const shown = i >= 0 && Math.abs(run.trajectory.times[i] - time) < gap;
      mark.setAttribute('visibility', shown ? 'visible' : 'hidden');
      if (!shown) return;
      mark.setAttribute('cx', x(run.trajectory.positions[3 * i + a]));
      mark.setAttribute('cy', y(run.trajectory.positions[3 * i + b]));
    });
    plot.append(mark);
    svg.append(plot);
    host.replaceChildren(svg);
  });
}

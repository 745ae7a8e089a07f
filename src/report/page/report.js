// Puts the page together from the run's data.

const run = JSON.parse(document.getElementById('run').textContent);
const summary = run.summary;
const cursor = new TimeCursor();
const byId = (id) => document.getElementById(id);
const ofError = (name) => summary.absolute_trajectory_error && summary.absolute_trajectory_error[name];
const inCentimetres = (error) => error ? formatNumber(100 * error.rmse_m) + ' cm' : '-';
const inSeconds = (value) => value === null ? '-' : formatNumber(value) + ' s';
const whole = (value) => value.toLocaleString('en');
const percent = (share) => (100 * share).toFixed(1) + ' %';

function drawTable(table, caption, head, rows) {
  table.replaceChildren();
  if (caption) table.createCaption().textContent = caption;
  if (head) {
    const row = table.createTHead().insertRow();
    for (const text of head) { const cell = document.createElement('th'); cell.scope = 'col'; cell.textContent = text; row.append(cell); }
  }
  const body = table.createTBody();
  for (const cells of rows) {
    const row = body.insertRow();
    for (const content of cells) row.insertCell().textContent = content;
  }
}

function drawHeadline() {
  const total = summary.stage_times_ms.total;
  const tiles = [];
  if (ofError('trajectory')) tiles.push([inCentimetres(ofError('trajectory')), 'trajectory error (RMSE after similarity alignment)', 'main']);
  if (ofError('live')) tiles.push([inCentimetres(ofError('live')), 'error of the poses given out live', '']);
  tiles.push([percent(summary.coverage_from_first_pose), 'of the frames from the first pose on have one', ofError('trajectory') ? '' : 'main'],
    [inSeconds(summary.first_pose_s), 'from the first frame to the first pose', ''],
    [whole(summary.frames.total), 'frames' + (summary.frames.unreadable ? `, ${whole(summary.frames.unreadable)} unreadable` : '') + ` in ${formatNumber(summary.recording_s)} s`, ''],
    [whole(summary.keyframes), 'keyframes', ''],
    [whole(summary.map_points), 'map points', '']);
  if (summary.wall_s > 0) tiles.push([formatNumber(summary.real_time_ratio) + ' ×', `real time (${formatNumber(summary.wall_s)} s in all)`, '']);
  if (total) tiles.push([formatNumber(total.mean) + ' ms', `a frame on average; 99 % within ${formatNumber(total.p99)} ms`, '']);
  byId('headline').replaceChildren(...tiles.map(([value, label, kind]) => {
    const tile = document.createElement('div');
    tile.className = 'tile ' + kind;
    const figure = document.createElement('b');
    figure.textContent = value;
    const text = document.createElement('span');
    text.textContent = label;
    tile.append(figure, text);
    return tile;
  }));
  byId('input').textContent = summary.input;
  byId('initialisation').textContent = summary.initialisation ? 'Initialisation: ' + summary.initialisation : 'The map was never started.';
  byId('worlds-in-words').hidden = !run.worlds_in_words;
  byId('worlds-in-words').textContent = run.worlds_in_words + '. Drawings and figures are of the main one.';
  byId('quality').hidden = !summary.recording_quality;
  byId('quality').textContent = 'The recording: ' + summary.recording_quality + '.';
}

function drawTrajectories() {
  const entries = [{ name: 'estimate', colour: 'var(--estimate)', kind: 'line' }, { name: 'as given out live', colour: 'var(--live)', kind: 'line' },
    { name: 'keyframes', colour: 'var(--keyframe)', kind: 'dot' }];
  if (run.truth) entries.push({ name: 'ground truth', colour: 'var(--truth)', kind: 'line' });
  drawLegend(byId('trajectory-legend'), entries);
  const spread = (axis) => {
    const box = { low: [Infinity, Infinity], high: [-Infinity, -Infinity] };
    growBox(box, run.trajectory.positions, axis, 2);
    return box.high[0] - box.low[0];
  };
  const across = run.aligned && spread(1) > spread(0) ? 1 : 0;
  const frame = run.aligned ? "in the ground truth's frame, after similarity alignment" : "in the frame of the first keyframe's camera (x right, y down, z forward); its scale is arbitrary";
  const [right, forward, up] = run.axes;
  byId('above-caption').textContent = `From above: ${right} to the right, ${forward} up the page, ${frame}.`;
  byId('side-caption').textContent = `From the side: ${run.axes[across]} to the right, ${up} up the page.`;
  planeView(byId('above'), run, 0, 1, 'Trajectory from above', cursor);
  planeView(byId('side'), run, across, 2, 'Trajectory from the side', cursor);
}

function drawOverTime() {
  const interval = run.frame_interval_ms / 1000;
  const gap = Math.max(0.25, 3.5 * interval);
  const lastRun = run.states[run.states.length - 1];
  const range = { from: 0, to: lastRun ? Math.max(lastRun.to, interval, 1e-3) : 1, cursor };
  const stateAt = (time) => run.states.find((state) => time >= state.from && time < state.to) || lastRun;

  const errors = [['final', run.error, 'var(--estimate)'], ['live', run.live_error, 'var(--live)']].filter((entry) => entry[1]);
  byId('error-figure').hidden = errors.length === 0;
  if (errors.length) {
    const highest = Math.max(...errors.map((entry) => entry[1].errors_cm.reduce((most, value) => Math.max(most, value), 0)), 1e-6);
    drawLegend(byId('error-legend'), errors.map(([name, , colour]) => ({ name: name === 'final' ? 'trajectory.txt' : 'as given out live', colour, kind: 'line' })));
    byId('error-caption').textContent = 'Distance to the ground truth after similarity alignment of each trajectory as a whole.';
    timeChart(byId('error'), Object.assign({ height: 210, low: 0, high: 1.06 * highest, unit: 'cm',
      label: `Position error over time, at most ${formatNumber(highest)} cm`,
      content: (svg, x, y) => { for (const [, series, colour] of errors.slice().reverse()) svg.append(svgElement('path', { d: linePath(series.times, series.errors_cm, x, y, gap), class: 'line', style: `stroke: ${colour}` })); },
      describe: (time) => `${time.toFixed(2)} s` + errors.map(([name, series]) => {
        const i = nearestIndex(series.times, time);
        return `\n${name}: ${i < 0 || Math.abs(series.times[i] - time) > gap ? '-' : formatNumber(series.errors_cm[i]) + ' cm'}`;
      }).join('') }, range));
  }

  const occurring = Object.entries(summary.states).filter(([, count]) => count > 0);
  drawLegend(byId('state-legend'), occurring.map(([name, count]) => ({ name: `${name} (${whole(count)})`, colour: `var(--${name})` })));
  timeChart(byId('state'), Object.assign({ height: 92, low: 0, high: 1, unit: '',
    label: 'State over time: ' + occurring.map(([name, count]) => `${name} ${count} frames`).join(', '),
    content: (svg, x, y, area) => {
      for (const state of run.states) {
        const box = { x: x(state.from), width: Math.max(x(state.to) - x(state.from), 0.75) };
        svg.append(svgElement('rect', Object.assign({ y: area.top - 6, height: 36, style: `fill: var(--${state.state})` }, box)));
        if (state.final_pose) svg.append(svgElement('rect', Object.assign({ y: area.top + 34, height: 8, style: 'fill: var(--estimate)' }, box)));
      }
    },
    describe: (time) => {
      const state = stateAt(time);
      return state ? `${state.from.toFixed(2)} to ${state.to.toFixed(2)} s: ${state.state}${state.reason ? '\n' + state.reason : ''}\n${whole(state.frames)} frames from ${state.first_frame} on` +
        (state.final_pose ? '' : '\nno pose in trajectory.txt') : '';
    } }, range));

  drawLegend(byId('points-legend'), [{ name: 'followed in the image', colour: 'var(--live)', kind: 'line' }, { name: 'of these in the map, used for the pose', colour: 'var(--estimate)', kind: 'line' }]);
  const mostPoints = run.frames.tracked.reduce((most, value) => Math.max(most, value), 1);
  timeChart(byId('points'), Object.assign({ height: 150, low: 0, high: 1.06 * mostPoints, unit: 'points', label: `Points over time, at most ${mostPoints}`,
    content: (svg, x, y) => svg.append(svgElement('path', { d: linePath(run.frames.times, run.frames.tracked, x, y, Infinity), class: 'line', style: 'stroke: var(--live)' }),
      svgElement('path', { d: linePath(run.frames.times, run.frames.mapped, x, y, Infinity), class: 'line', style: 'stroke: var(--estimate)' })),
    describe: (time) => { const i = nearestIndex(run.frames.times, time); return i < 0 ? '' : `${time.toFixed(2)} s\nfollowed: ${run.frames.tracked[i]}\nin the map: ${run.frames.mapped[i]}`; } }, range));

  const stages = run.stages;
  drawLegend(byId('stages-legend'), stages.names.map((name, k) => ({ name, colour: `var(--series-${k % 10})` })));
  const totals = stages.times.map((time, i) => stages.series.reduce((sum, values) => sum + values[i], 0));
  // A few slow frames (keyframes, the start) must not press all others flat.
  const highest = Math.max(1.1 * quantile(totals, 0.99), 1.2 * run.frame_interval_ms, 1e-3);
  const cut = totals.filter((total) => total > highest).length;
  byId('stages-caption').textContent = (stages.frames_per_sample > 1 ? `Means over ${stages.frames_per_sample} frames. ` : '') +
    (run.frame_interval_ms > 0 ? `Dashed: the time between two frames, ${formatNumber(run.frame_interval_ms)} ms. ` : '') +
    (cut ? `${cut} of ${totals.length} columns go beyond the top, up to ${formatNumber(Math.max(...totals))} ms.` : '');
  timeChart(byId('stages'), Object.assign({ height: 220, low: 0, high: highest, unit: 'ms', label: 'Time of each stage over time; the table below gives the figures',
    content: (svg, x, y, area) => {
      stackedAreas(svg, stages.times, stages.series, x, (value) => y(Math.min(value, highest)));
      if (run.frame_interval_ms > 0) svg.append(svgElement('line', { x1: area.left, x2: area.right, y1: y(run.frame_interval_ms), y2: y(run.frame_interval_ms), class: 'budget' }));
    },
    describe: (time) => {
      const i = nearestIndex(stages.times, time);
      return i < 0 ? '' : `${time.toFixed(2)} s: ${formatNumber(totals[i])} ms\n` + stages.names.map((name, k) => `${name}: ${stages.series[k][i].toFixed(2)}`).join('\n');
    } }, range));
}

function drawPublished() {
  if (!run.published) return;
  byId('published-section').hidden = false;
  const ours = ofError('keyframes');
  const values = [['this run', ours ? (100 * ours.rmse_m).toFixed(2) : summary.absolute_trajectory_error ? 'X' : 'no ground truth'], ...Object.entries(run.published.errors_cm)];
  drawTable(byId('published'), '', ['', ...values.map((entry) => entry[0])], [[run.published.sequence, ...values.map((entry) => entry[1])]]);
  const figures = values.map((entry) => Number.parseFloat(entry[1]));
  const best = Math.min(...figures.filter(Number.isFinite));
  figures.forEach((figure, i) => { if (figure === best) byId('published').tBodies[0].rows[0].cells[i + 1].className = 'best'; });
}

function drawDrawings() {
  byId('drawings-section').hidden = run.drawings.length === 0;
  byId('drawings').replaceChildren(...run.drawings.map((drawing) => {
    const figure = document.createElement('figure');
    const image = document.createElement('img');
    image.src = drawing.image;
    image.width = drawing.width;
    image.height = drawing.height;
    const text = `Frame ${drawing.frame}` + (drawing.state ? `, ${drawing.time.toFixed(2)} s: ${drawing.state}${drawing.reason ? ' (' + drawing.reason + ')' : ''}, ` +
      `${drawing.tracked} points followed, ${drawing.mapped} in the map${drawing.keyframe ? ', keyframe' : ''}` : '');
    image.alt = text;
    image.addEventListener('click', () => figure.classList.toggle('large'));
    const caption = document.createElement('figcaption');
    caption.textContent = text;
    figure.append(image, caption);
    return figure;
  }));
}

function drawFigures() {
  const scale = ofError('trajectory') ? formatNumber(ofError('trajectory').scale) + ' m' : '-';
  const rows = [['Frames', whole(summary.frames.total)], ['Unreadable frames', whole(summary.frames.unreadable)],
    ['Frames with a pose in trajectory.txt', whole(summary.frames.with_pose)], ['Frames with a good live pose', whole(summary.frames.with_live_pose)],
    ['Coverage from the first pose on', percent(summary.coverage_from_first_pose)], ['First pose after', inSeconds(summary.first_pose_s)],
    ['First live pose after', inSeconds(summary.first_live_pose_s)], ['Keyframes', whole(summary.keyframes)], ['Map points', whole(summary.map_points)],
    ['Length of the recording', inSeconds(summary.recording_s)], ['Time of the run', inSeconds(summary.wall_s)], ['Times real time', formatNumber(summary.real_time_ratio)]];
  if (summary.latency_ms) {
    rows.push(['Frames dropped, newer ones being there', whole(summary.frames.dropped)],
      ['Latency from frame to pose (median; 99 %; largest)', [summary.latency_ms.p50, summary.latency_ms.p99, summary.latency_ms.max].map((value) => value.toFixed(1)).join('; ') + ' ms'],
      ['Results before the next frame was due', percent(summary.share_within_frame_interval)]);
  }
  if (summary.absolute_trajectory_error) {
    for (const [name, label] of [['trajectory', 'trajectory.txt'], ['live', 'trajectory_live.txt'], ['keyframes', 'keyframes.txt']]) {
      const error = ofError(name);
      rows.push([`Error of ${label} (RMSE; median; largest)`, error ? `${inCentimetres(error)}; ${formatNumber(100 * error.median_m)}; ${formatNumber(100 * error.max_m)}` : 'too few poses to compare']);
    }
    rows.push(['One map unit after alignment', scale]);
  }
  drawTable(byId('figures'), 'Key figures', null, rows);
  drawTable(byId('stage-table'), 'Time of each stage [ms]', ['stage', 'frames', 'mean', 'median', '99 %', 'max'],
    Object.entries(summary.stage_times_ms).map(([name, stage]) => [name, whole(stage.frames), ...[stage.mean, stage.p50, stage.p99, stage.max].map((value) => value.toFixed(2))]));
  const threads = Object.entries(summary.thread_durations_ms);
  if (threads.length) {
    drawTable(byId('thread-table'), 'Work of each thread, and what waited for it [ms]', ['', 'times', 'mean', 'median', '99 %', 'max'],
      threads.map(([name, times]) => [name, whole(times.count), ...[times.mean, times.p50, times.p99, times.max].map((value) => value.toFixed(2))]));
  }
  drawTable(byId('state-table'), 'Frames in each state', ['state', 'frames', 'share'],
    Object.entries(summary.states).map(([name, count]) => [name, whole(count), summary.frames.total ? percent(count / summary.frames.total) : '-']));
  if (summary.worlds.length > 1) {
    drawTable(byId('world-table'), 'Maps that were not joined, the main one first', ['trajectory', 'frames with a pose', 'first pose after', 'keyframes', 'points'],
      summary.worlds.map((world, i) => [`trajectory${i ? '_map' + i : ''}.txt`, whole(world.frames_with_pose), inSeconds(world.first_pose_s), whole(world.keyframes), whole(world.map_points)]));
  }
  byId('configuration').textContent = summary.configuration;
  drawTable(byId('versions'), '', null, [['edgeslam', summary.versions.edgeslam], ...Object.entries(summary.versions.libraries), ['Command', summary.command_line]]);
  for (const row of byId('versions').rows) row.cells[1].className = 'text';
}

drawHeadline();
drawTrajectories();
drawOverTime();
drawPublished();
drawDrawings();
drawFigures();
mapView(byId('map'), run, { colour: byId('map-colour'), sigma: byId('map-sigma'), sigmaValue: byId('map-sigma-value'), lines: byId('map-lines'),
  frusta: byId('map-frusta'), reset: byId('map-reset'), caption: byId('map-caption') }, cursor);

// Puts the page of two runs together.

const { first, second } = page;
const cursor = new TimeCursor();
const colours = ['var(--estimate)', 'var(--live)'];
const bothNames = [{ name: 'A', colour: colours[0], kind: 'line' }, { name: 'B', colour: colours[1], kind: 'dashed' }];
const gap = Math.max(0.25, 3.5 * page.frame_interval_ms / 1000);
const marks = { better: '▲ better', worse: '▼ worse', same: '= about the same', different: '≠ different', unknown: '-' };

// Change in per cent, where that says something.
function changeText(figure) {
  const mark = marks[figure.verdict];
  if (!known(figure.first) || !known(figure.second) || figure.verdict === 'same') return mark;
  const change = figure.second - figure.first;
  const sign = change > 0 ? '+' : '−';
  const ofHundred = figure.unit !== '%' && figure.first > 0 ? Math.abs(100 * change / figure.first) : null;
  const amount = ofHundred === null ? formatNumber(Math.abs(change)) + (figure.unit === '%' ? ' points' : '')
    : ofHundred > 400 ? `× ${formatNumber(figure.second / figure.first)}` : `${sign}${ofHundred < 10 ? ofHundred.toFixed(1) : Math.round(ofHundred)} %`;
  return `${mark} (${ofHundred === null ? sign : ''}${amount})`;
}

function figureText(value, unit) {
  if (!known(value)) return '-';
  const text = Number.isInteger(value) && !unit ? whole(value) : unit === '%' ? value.toFixed(1) : formatNumber(value);
  return unit ? `${text}\u00a0${unit}` : text;
}

function drawFigures() {
  byId('first-name').textContent = first.folder + (first.sequence === second.sequence ? '' : ', ' + first.sequence);
  byId('second-name').textContent = second.folder + (first.sequence === second.sequence ? '' : ', ' + second.sequence);
  const count = (verdict) => page.figures.filter((figure) => figure.verdict === verdict).length;
  byId('verdicts').textContent = first.sequence !== second.sequence ? 'The runs are over different sequences: read the marks with care.'
    : `B is better in ${count('better')} figures and worse in ${count('worse')}; ${count('same')} are about the same.`;
  drawTable(byId('figures'), ['', 'A', 'B', 'from A to B'], page.figures.map((figure) => [figure.name, figureText(figure.first, figure.unit),
    figureText(figure.second, figure.unit), { text: changeText(figure), kind: figure.verdict }]));
}

function drawTrajectories() {
  drawLegend(byId('trajectory-legend'), bothNames);
  const relation = { 'ground truth': "in the ground truth's frame, each aligned to it as in its report",
    'first run': `B aligned to A (similarity, poses at the same times)${page.unit === 'm' ? ", in the ground truth's frame" : ''}`,
    none: 'each in a frame of its own: too few poses are at the same times to align one to the other' }[page.relation];
  const both = { trajectory: first.trajectory, other: second.trajectory, keyframes: [], axes: page.axes, unit: page.unit, frame_interval_ms: page.frame_interval_ms };
  const spread = (axis) => {
    const box = { low: [Infinity, Infinity], high: [-Infinity, -Infinity] };
    growBox(box, first.trajectory.positions, axis, 2);
    growBox(box, second.trajectory.positions, axis, 2);
    return box.high[0] - box.low[0];
  };
  const across = page.relation !== 'none' && spread(1) > spread(0) ? 1 : 0;
  byId('above-caption').textContent = `From above: ${page.axes[0]} to the right, ${page.axes[1]} up the page, ${relation}.`;
  byId('side-caption').textContent = `From the side: ${page.axes[across]} to the right, ${page.axes[2]} up the page.`;
  planeView(byId('above'), both, 0, 1, 'Both trajectories from above', cursor);
  planeView(byId('side'), both, across, 2, 'Both trajectories from the side', cursor);
}

function endOf(run) {
  const last = run.states[run.states.length - 1];
  return last ? last.to : 0;
}

function drawDistance(range) {
  byId('distance-figure').hidden = !page.distance;
  if (!page.distance) return;
  const inMetres = page.unit === 'm';
  const factor = inMetres ? 100 : 1;
  const unit = inMetres ? 'cm' : 'map units';
  const values = page.distance.distances.map((value) => factor * value);
  const text = (value) => value < 1e-9 ? '0' : formatNumber(factor * value);  // below it is rounding
  const largest = Math.max(factor * page.distance.max, inMetres ? 1e-3 : 1e-5);
  byId('distance-caption').textContent = `Of poses at the same times: RMSE ${text(page.distance.rmse)} ${unit}, median ${text(page.distance.median)}, largest ${text(page.distance.max)}.`;
  timeChart(byId('distance'), Object.assign({ height: 190, low: 0, high: 1.06 * largest, unit,
    label: `Distance between the runs over time, at most ${text(page.distance.max)} ${unit}`,
    content: (svg, x, y) => svg.append(svgElement('path', { d: linePath(page.distance.times, values, x, y, gap), class: 'line', style: 'stroke: var(--estimate)' })),
    describe: (time) => { const i = nearestIndex(page.distance.times, time); return i < 0 || Math.abs(page.distance.times[i] - time) > gap ? '' : `${time.toFixed(2)} s: ${formatNumber(values[i])} ${unit}`; } }, range));
}

function drawStates(host, run, label, range) {
  const counts = Object.entries(run.counts).filter(([, count]) => count > 0);
  timeChart(byId(host), Object.assign({ height: 84, low: 0, high: 1, unit: '', label: `State of ${label} over time: ` + counts.map(([name, count]) => `${name} ${count} frames`).join(', '),
    content: (svg, x, y, area) => {
      for (const state of run.states) {
        const box = { x: x(state.from), width: Math.max(x(state.to) - x(state.from), 0.75) };
        svg.append(svgElement('rect', Object.assign({ y: area.top - 8, height: 32, style: `fill: var(--${cssName(state.state)})` }, box)));
        if (state.final_pose) svg.append(svgElement('rect', Object.assign({ y: area.top + 28, height: 6, style: 'fill: var(--estimate)' }, box)));
      }
    },
    describe: (time) => {
      const state = run.states.find((stretch) => time >= stretch.from && time < stretch.to);
      return state ? `${label}, ${state.from.toFixed(2)} to ${state.to.toFixed(2)} s: ${state.state}${state.reason ? '\n' + state.reason : ''}\n${whole(state.frames)} frames` : '';
    } }, range));
}

// A state of a newer version has no colour, and its name must not become a style.
const cssName = (state) => ['initialising', 'tracking', 'predicted', 'recovered', 'relocalised', 'lost'].includes(state) ? state : 'axis';

function drawTimes(range) {
  const all = first.frame_times.values_ms.concat(second.frame_times.values_ms).sort((a, b) => a - b);
  const high = Math.max(1.15 * (all[Math.floor(0.99 * (all.length - 1))] || 0), 1e-3);  // the same for both
  [first, second].forEach((run, k) => {
    const { times, values_ms: values } = run.frame_times;
    timeChart(byId(['first-times', 'second-times'][k]), Object.assign({ height: 130, low: 0, high, unit: 'ms', label: `Tracking time of each frame of ${'AB'[k]}; the table below gives the figures`,
      content: (svg, x, y) => svg.append(svgElement('path', { d: linePath(times, values, x, (value) => y(Math.min(value, high)), Infinity), class: 'line', style: `stroke: ${colours[k]}; stroke-width: 1.1` })),
      describe: (time) => { const i = nearestIndex(times, time); return i < 0 ? '' : `${'AB'[k]}, ${time.toFixed(2)} s: ${values[i].toFixed(2)} ms`; } }, range));
  });
}

function drawStages() {
  const ms = (stage, key) => stage ? stage[key].toFixed(2) : '-';
  const change = (stage) => {
    if (!stage.first || !stage.second || stage.first.p50 <= 0 || stage.second.p50 <= 0) return { text: '-', kind: 'unknown' };
    const ratio = stage.second.p50 / stage.first.p50;
    const verdict = ratio > 1.1 ? 'worse' : ratio < 0.9 ? 'better' : 'same';
    return { text: verdict === 'same' ? marks.same : `${marks[verdict]} (× ${ratio.toFixed(2)})`, kind: verdict };
  };
  drawTable(byId('stages'), ['stage', ['A', 'median'], ['B', 'median'], ['A', '99 %'], ['B', '99 %'], ['A', 'frames'], ['B', 'frames'], 'median from A to B'],
    page.stages.map((stage) => [stage.name, ms(stage.first, 'p50'), ms(stage.second, 'p50'), ms(stage.first, 'p99'), ms(stage.second, 'p99'),
      whole(stage.first && stage.first.frames), whole(stage.second && stage.second.frames), change(stage)]));
}

function drawDifferences(name, list) {
  byId('no-' + name).hidden = list.length > 0;
  if (list.length) drawTable(byId(name), ['', 'A', 'B'], list.map((line) => [line.name, { text: line.first, kind: 'value' }, { text: line.second, kind: 'value' }]));
}

drawFigures();
drawTrajectories();
const range = { from: 0, to: Math.max(endOf(first), endOf(second), 1e-3), cursor };
drawDistance(range);
const occurring = [...new Set([first, second].flatMap((run) => Object.entries(run.counts).filter(([, count]) => count > 0).map(([name]) => name)))];
drawLegend(byId('state-legend'), occurring.map((name) => ({ name: `${name} (A ${whole(first.counts[name] || 0)}, B ${whole(second.counts[name] || 0)})`, colour: `var(--${cssName(name)})` })));
drawStates('first-state', first, 'A', range);
drawStates('second-state', second, 'B', range);
drawTimes(range);
drawStages();
drawDifferences('settings', page.settings);
drawDifferences('origins', page.origins);

// Puts the page of a set of runs together.

const runs = page.runs;
const done = runs.filter((run) => run.figures);
const failed = runs.filter((run) => run.failed);
const stateNames = ['initialising', 'tracking', 'predicted', 'recovered', 'relocalised', 'lost'];
const cssName = (state) => stateNames.includes(state) ? state : 'axis';
const seconds = (value) => known(value) ? formatNumber(value) : '-';
const median = (values) => values.length ? values.slice().sort((a, b) => a - b)[Math.floor((values.length - 1) / 2)] : null;

// A figure of the run, leading to its report.
const cell = (run, text, kind) => ({ text, link: run.link, kind });
const nameCell = (run) => cell(run, run.name, 'name');
const errorText = (run, error) => error ? (100 * error.rmse_m).toFixed(2) : run.figures.has_ground_truth ? 'X' : 'no ground truth';

function drawHeadline() {
  const errors = done.filter((run) => run.figures.trajectory).map((run) => 100 * run.figures.trajectory.rmse_m);
  const speeds = done.map((run) => run.figures.real_time_ratio).filter((ratio) => ratio > 0);
  const tiles = [[`${runs.length - failed.length} of ${runs.length}`, 'runs have poses', 'main']];
  if (errors.length) tiles.push([formatNumber(median(errors)) + ' cm', 'median of the trajectory errors', '']);
  const posed = done.filter((run) => !run.failed);
  if (posed.length) tiles.push([percent(Math.min(...posed.map((run) => run.figures.coverage))), 'least coverage from the first pose on', '']);
  if (speeds.length) tiles.push([formatNumber(Math.min(...speeds)) + ' ×', 'real time, the slowest run', '']);
  drawTiles(byId('headline'), tiles);
  byId('note').textContent = page.note;
}

function drawFailed() {
  byId('failed-section').hidden = failed.length === 0;
  if (failed.length) drawTable(byId('failed'), ['sequence', ''], failed.map((run) => [nameCell(run), { text: '✕ ' + run.message, kind: 'failed' }]));
}

function drawPublished() {
  const published = runs.filter((run) => run.published);
  byId('published-section').hidden = published.length === 0;
  if (!published.length) return;
  const systems = Object.keys(published[0].published.errors_cm);
  drawTable(byId('published'), ['sequence', 'this set', ...systems], published.map((run) => {
    const texts = [run.figures ? errorText(run, run.figures.keyframe_error) : 'X', ...systems.map((system) => run.published.errors_cm[system])];
    const figures = texts.map(Number.parseFloat);
    const best = Math.min(...figures.filter(Number.isFinite));
    return [cell(run, run.published.sequence, 'name'), ...texts.map((text, i) => {
      const kind = figures[i] === best ? 'best' : '';
      return i === 0 ? cell(run, (kind ? '● ' : '') + text, kind) : { text: (kind ? '● ' : '') + text, kind };
    })];
  }));
}

// The row of a run, or what went wrong with it over all columns.
function rows(columns, cells) {
  return runs.map((run) => run.figures ? [nameCell(run), ...cells(run, run.figures)] : [nameCell(run), { text: '✕ ' + run.message, kind: 'failed', span: columns }]);
}

function drawAccuracy() {
  drawTable(byId('accuracy'), ['sequence', ['error', 'cm'], ['live', 'cm'], ['keyframes', 'cm'], 'coverage', ['posed', 'of all frames'], 'maps', ['posed', 'in any map'], ['first pose', 's'], 'recoveries', 'relocalisations', 'loops',
    ['error before', 'last loop, cm'], ['after it', 'cm'], 'keyframes', 'points'],
  rows(15, (run, f) => {
    const last = f.loops[f.loops.length - 1];
    const atLoop = (error) => error ? (100 * error.rmse_m).toFixed(2) : '-';
    return [errorText(run, f.trajectory), errorText(run, f.live), errorText(run, f.keyframe_error), percent(f.coverage), percent(f.posed), whole(f.worlds), percent(f.posed_in_any_world), seconds(f.first_pose_s), whole(f.recoveries),
      whole(f.relocalisations), whole(f.loops.length), last ? atLoop(last.before) : '-', last ? atLoop(last.after) : '-', whole(f.keyframes), whole(f.map_points)].map((text) => cell(run, text));
  }));
}

function drawSpeed() {
  const ms = (value) => known(value) ? value.toFixed(2) : '-';
  drawTable(byId('speed'), ['sequence', ['tracking', 'median, ms'], ['tracking', '99 %, ms'], ['whole frame', 'mean, ms'], 'x real time', ['recording', 's'], ['run', 's'], 'frames', ['processor', '% of real time'], ['memory', 'MiB']],
    rows(9, (run, f) => [ms(f.tracking_ms && f.tracking_ms.p50), ms(f.tracking_ms && f.tracking_ms.p99), ms(f.total_ms && f.total_ms.mean), formatNumber(f.real_time_ratio),
      f.recording_s.toFixed(1), f.wall_s.toFixed(1), whole(f.frames), known(run.cpu_s) && f.recording_s > 0 ? Math.round(100 * run.cpu_s / f.recording_s) + ' %' : '-',
      known(run.peak_mib) ? whole(Math.round(run.peak_mib)) : '-'].map((text) => cell(run, text))));
  byId('speed-note').textContent = 'Tracking: what a frame waits for; whole frame: with mapping and places, where the run did them in turn.' +
    (page.jobs > 1 ? ` ${page.jobs} runs went on at once: each alone may be faster.` : '');
}

function drawLoops() {
  const loops = done.flatMap((run) => run.figures.loops.map((loop) => ({ run, loop })));
  byId('loops-section').hidden = loops.length === 0;
  const text = (error) => error ? formatNumber(100 * error.rmse_m) + ' cm' : '-';
  drawTable(byId('loops'), ['sequence', 'frame', 'found', 'error before', 'error after', ''], loops.map(({ run, loop }) => {
    const verdict = !loop.before || !loop.after ? 'unknown' : loop.after.rmse_m < 0.95 * loop.before.rmse_m ? 'better' : loop.after.rmse_m > 1.05 * loop.before.rmse_m ? 'worse' : 'same';
    return [nameCell(run), cell(run, whole(loop.frame)), cell(run, loop.how), cell(run, text(loop.before)), cell(run, text(loop.after)),
      { text: { better: '▲ better', worse: '▼ worse', same: '= about the same', unknown: '-' }[verdict], kind: verdict }];
  }));
}

function drawStates() {
  const occurring = [...new Set(done.flatMap((run) => Object.entries(run.figures.states).filter(([, count]) => count > 0).map(([name]) => name)))];
  occurring.sort((a, b) => stateNames.indexOf(a) - stateNames.indexOf(b));
  drawLegend(byId('state-legend'), occurring.map((name) => ({ name, colour: `var(--${cssName(name)})` })));
  drawTable(byId('states'), ['sequence', 'share of the frames', ...occurring], done.map((run) => {
    const bar = document.createElement('div');
    bar.className = 'shares';
    bar.setAttribute('role', 'img');
    bar.setAttribute('aria-label', occurring.map((name) => `${name} ${run.figures.states[name] || 0} frames`).join(', '));
    const share = (name) => (run.figures.states[name] || 0) / Math.max(1, run.figures.frames);
    for (const name of occurring) {
      const part = document.createElement('i');
      part.style.width = 100 * share(name) + '%';
      part.style.background = `var(--${cssName(name)})`;
      bar.append(part);
    }
    return [nameCell(run), { node: bar, kind: 'bar' }, ...occurring.map((name) => cell(run, percent(share(name))))];
  }));
}

drawHeadline();
drawFailed();
drawPublished();
drawAccuracy();
drawSpeed();
drawLoops();
drawStates();

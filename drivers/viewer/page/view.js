'use strict';
// Puts the page together: what comes from the stream goes to its place, what a person wants goes to the program.

const element = (id) => document.getElementById(id);

const STATE_TEXT = {
  initialising: 'Initialising', tracking: 'Tracking', predicted: 'Predicted', recovered: 'Found again', relocalised: 'Found again', lost: 'Lost',
};
// Where the program gives no reason of its own.
const STATE_REASON = {
  initialising: 'There is no map yet.', tracking: 'The pose is measured.', predicted: 'The pose is a guess from the motion before.',
  recovered: 'The pose is measured again after a loss.', relocalised: 'The camera was found again in the whole map.', lost: 'There is no pose.',
};

const frames = new FrameHistory();
const picture = new PictureView(element('picture'), { edges: element('show-edges'), tracks: element('show-tracks'), trails: element('show-trails') }, tellPicture);
const map = new MapView(element('map'), { follow: element('map-follow'), uncertain: element('map-uncertain'), reset: element('map-reset') });
const graphs = Object.fromEntries(['latency', 'tracking', 'rate', 'points'].map((name) => [name, { canvas: element(name + '-graph'), value: element(name + '-value') }]));
const marks = { from: null, to: null };
const drops = []; // {time, captured, dropped} of the last ten seconds
let latest = null; // state
let hello = null;

function setText(node, text) { if (node.textContent !== text) node.textContent = text; }

const number = (value) => (Number.isFinite(value) ? value.toLocaleString('en') : '–');

function scaleText(scale) {
  if (scale.from === 'unknown') return 'unknown';
  return `${scale.metres_per_unit.toPrecision(4)} m ± ${(100 * scale.sigma).toPrecision(2)} %`;
}

const length = (vector) => Math.hypot(...vector);

function inertiaText(frame) {
  if (!frame || !frame.pose) return '–';
  const inertia = frame.inertia;
  if (!inertia) return 'none';
  const bias = inertia.bias
    ? `, biases ${length(inertia.bias.rate).toPrecision(2)} rad/s, ${length(inertia.bias.force).toPrecision(2)} m/s²` : '';
  return (inertia.up ? 'up is known' : 'up is not known yet') + bias;
}

function duration(ms) {
  if (!(ms >= 0)) return '–';
  const s = Math.floor(ms / 1000);
  return (s >= 3600 ? Math.floor(s / 3600) + ':' : '') + String(Math.floor(s / 60) % 60).padStart(s >= 3600 ? 2 : 1, '0') + ':' + String(s % 60).padStart(2, '0');
}

function showFigures(state) {
  const status = state.status;
  const figures = {
    'Keyframes': number(status.keyframes), 'Map points': number(status.points), 'Maps not joined': number(status.worlds),
    'Map unit': scaleText(state.scale), 'Found again': number(status.recoveries + status.relocalisations), 'Loops closed': number(status.loops),
    'Frames dropped': number(status.dropped), 'Running for': duration(status.uptime_ms),
    'Inertial unit': inertiaText(state.frame),
  };
  const list = element('figures');
  if (list.children.length === 0) {
    for (const name of Object.keys(figures)) {
      const group = document.createElement('div');
      group.append(document.createElement('dt'), document.createElement('dd'));
      group.firstChild.textContent = name;
      list.append(group);
    }
  }
  Object.values(figures).forEach((value, i) => setText(list.children[i].lastChild, value));
}

function dropWarning(status) {
  const now = performance.now() / 1000;
  const last = drops[drops.length - 1];
  if (last && (status.captured < last.captured || status.dropped < last.dropped)) drops.length = 0;
  drops.push({ time: now, captured: status.captured, dropped: status.dropped });
  while (drops[0].time < now - 10) drops.shift();
  const captured = status.captured - drops[0].captured;
  const dropped = status.dropped - drops[0].dropped;
  return captured > 20 && dropped > 0.05 * captured ? `The computer is too slow: ${dropped} frames of ${captured} were dropped in the last 10 s.` : '';
}

function showWarnings(state) {
  const status = state.status;
  const sentences = [
    status.camera_problem && 'No frames: ' + status.camera_problem, dropWarning(status),
    state.lcm_problem && 'Poses do not reach the robot: ' + state.lcm_problem,
    status.scale_problem && (state.scale.from === 'unknown' ? 'The scale is not known yet: ' : 'The scale is not renewed: ') + status.scale_problem,
    status.unreadable > 0 && `${number(status.unreadable)} frames could not be read.`, state.note,
  ].filter(Boolean);
  const list = element('warnings');
  const items = sentences.length ? sentences : ['No warnings.'];
  if (list.dataset.shown === items.join('\n')) return;
  list.dataset.shown = items.join('\n');
  list.replaceChildren(...items.map((text) => Object.assign(document.createElement('li'), { textContent: text, className: sentences.length ? '' : 'calm' })));
}

function showState(state) {
  latest = state;
  const frame = state.frame;
  if (frame) {
    const name = state.status.camera_problem ? 'lost' : frame.state;
    element('state').dataset.state = name;
    setText(element('state-name'), state.status.camera_problem ? 'No camera' : STATE_TEXT[name] || name);
    setText(element('reason'), (frame.reason && frame.reason[0].toUpperCase() + frame.reason.slice(1) + '.') || STATE_REASON[name] || '');
    if (frame.pose) map.setUp(frame.inertia && frame.inertia.up);
    map.moveCamera(frame.pose, frame.utime / 1e6, frame.state, frame.world);
  } else if (state.status.camera_problem) {
    element('state').dataset.state = 'lost';
    setText(element('state-name'), 'No camera');
  }
  element('recording').hidden = !state.status.recording;
  for (const [utime, name, latency_ms, tracking_ms] of state.samples) {
    const counts = frame && frame.utime === utime ? { tracked: frame.tracked, mapped: frame.mapped } : {};
    frames.add({ time: utime / 1e6, state: name, latency_ms, tracking_ms, ...counts });
  }
  showFigures(state);
  showWarnings(state);
}

function showHello(message) {
  hello = message;
  const { width, height } = message.camera;
  document.documentElement.style.setProperty('--aspect', `${width} / ${height}`);
  setText(element('source'), `${message.source}, ${width} × ${height}, version ${message.version}`);
  element('source').title = message.source;
  document.title = 'Edge SLAM: ' + message.source.replace(/^.*\/(?=.)/, '');
  map.setCamera(message.camera);
  for (const control of document.querySelectorAll('[data-command]')) control.hidden = !message.commands.includes(control.dataset.command);
}

function tellPicture(description) {
  setText(element('picture-caption'), `Frame ${description.index}, ${description.state}: ${number(description.tracks)} points are followed.`);
}

function showMap(description, rest) {
  map.show(description, rest);
  const thinned = description.points < description.points_in_map ? `, ${number(description.points)} of them are sent` : '';
  setText(element('map-caption'), `${number(description.points_in_map)} points${thinned}, ${number(description.keyframes_in_map)} keyframes${latest && latest.status.worlds > 1 ? ` of map ${description.world}, where the camera is` : ''}. Drag to turn, wheel or pinch to come nearer.`);
}

function showConnection(kind, text) {
  element('connection').dataset.connection = kind;
  setText(element('connection'), text);
  document.body.classList.toggle('stale', kind !== 'connected');
  for (const button of document.querySelectorAll('#commands button')) button.disabled = kind !== 'connected';
}

function tellAnswer(name, answer) {
  const item = document.createElement('li');
  item.textContent = `${new Date().toLocaleTimeString('en-GB')} ${name}: ${answer.message}`;
  item.className = answer.accepted ? 'accepted' : 'refused';
  element('answers').prepend(item);
  while (element('answers').children.length > 6) element('answers').lastChild.remove();
}

async function command(name, message) { tellAnswer(name, await sendCommand(message)); }

// What cannot be undone asks once more, for four seconds.
function isSure(button) {
  if (!button.dataset.sure || button.classList.contains('sure')) {
    button.classList.remove('sure');
    if (button.dataset.usual) button.textContent = button.dataset.usual;
    return true;
  }
  button.dataset.usual = button.textContent;
  button.textContent = button.dataset.sure;
  button.classList.add('sure');
  setTimeout(() => { button.classList.remove('sure'); button.textContent = button.dataset.usual; }, 4000);
  return false;
}

for (const button of document.querySelectorAll('button[data-command]')) {
  button.addEventListener('click', () => {
    const name = button.dataset.usual || button.textContent;
    if (isSure(button)) command(name, { command: button.dataset.command });
  });
}

function showMarks() {
  const text = (mark) => (mark ? `at frame ${mark.index}` : 'not marked');
  setText(element('scale-marks'), `Start ${text(marks.from)}, end ${text(marks.to)}.`);
}
for (const which of ['from', 'to']) {
  element('scale-' + which).addEventListener('click', () => {
    if (latest && latest.frame && isMeasured(latest.frame.state)) marks[which] = latest.frame;
    else tellAnswer('Mark', { accepted: false, message: 'there is no measured pose now' });
    showMarks();
  });
}
element('scale-form').addEventListener('submit', (event) => {
  event.preventDefault();
  if (!marks.from || !marks.to) return tellAnswer('Set the scale', { accepted: false, message: 'mark the start and the end first' });
  command('Set the scale', { command: 'set_scale', from_utime: marks.from.utime, to_utime: marks.to.utime, distance_m: Number(element('scale-distance').value) });
});

setInterval(() => drawGraphs(frames, graphs), 250);
followStream({ hello: showHello, state: showState, map: showMap, picture: (description, rest) => picture.show(description, rest), connection: showConnection });

'use strict';
// The map in three dimensions: points of edges joined to lines, keyframes and their way, the camera as it is now.

const MOST_CERTAIN = 25; // [%] of the depth: points that are known worse are drawn on request only
const TAIL_SECONDS = 10;
const FIRST_UP = [0, -1, 0]; // while nothing says where up is: the world is the first camera's frame, y down
const LEAST_TURN = 0.02; // [rad]: what is known of up is improved all the time
const NEW = 0xffffffff; // of a run of the map: not in the one before
const FRUSTUM_LINES = [[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [2, 3], [3, 4], [4, 1]];

// A list of `count` items of `size` numbers each, put together of items of the list before and of new ones. `runs`: pairs of
// where a run begins in the list before (NEW: it is of the new ones) and its length.
function putTogether(runs, count, size, before, added) {
  const whole = new added.constructor(size * count);
  let at = 0;
  let taken = 0;
  for (let i = 0; i < runs.length; i += 2) {
    const [from, length] = [runs[i], runs[i + 1]];
    const source = from === NEW ? added.subarray(size * taken, size * (taken + length)) : before.subarray(size * from, size * (from + length));
    if (source.length !== size * length) throw new RangeError('a map that does not fit the one before');
    whole.set(source, size * at);
    at += length;
    if (from === NEW) taken += length;
  }
  return whole;
}

// `before`: the map read last, of which the message says what changed; or null.
function readMap(description, rest, before) {
  if (description.after !== 0 && description.after !== (before && before.number)) throw new RangeError('a map that follows another one');
  const known = description.after !== 0 ? before : { positions: [], greys: [], sigmas: [], joins: [], keyframes: [] };
  let at = 0;
  const take = (Kind, length) => { at += length * Kind.BYTES_PER_ELEMENT; return new Kind(rest.buffer.slice(at - length * Kind.BYTES_PER_ELEMENT, at)); };
  const runs = take(Uint32Array, 2 * description.point_runs);
  const keyframeRuns = take(Uint32Array, 2 * description.keyframe_runs);
  const count = description.points;
  const added = description.new_points;
  const positions = putTogether(runs, count, 3, known.positions, take(Float32Array, 3 * added));
  const keyframes = putTogether(keyframeRuns, description.keyframes, 7, known.keyframes, take(Float32Array, 7 * description.new_keyframes));
  const straight = take(Float32Array, 6 * description.lines);
  const [greys, sigmas, joins] = ['greys', 'sigmas', 'joins'].map((name) => putTogether(runs, count, 1, known[name], take(Uint8Array, added)));
  return { number: description.number, count, positions, greys, sigmas, joins, keyframes, straight, world: description.world };
}

function quantile(values, share) {
  const sorted = Float64Array.from(values).sort();
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : 0;
}

function setPositions(geometry, positions) {
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
}

class MapView {
  // `controls`: {follow, uncertain, reset} are elements of the page.
  constructor(host, controls) {
    this.host = host;
    this.controls = controls;
    this.tail = [];
    this.touched = false;
    try {
      this.renderer = new THREE.WebGLRenderer({ antialias: true });
    } catch (error) {
      host.querySelector('.empty').textContent = 'This browser offers no WebGL, which the map needs.';
      return;
    }
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    const canvas = this.renderer.domElement;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', '3D map. Arrow keys turn it, plus and minus come nearer and go back.');
    canvas.tabIndex = 0;
    host.prepend(canvas);
    this.build(canvas);
    controls.reset.addEventListener('click', () => { this.touched = false; this.fit(); });
    controls.uncertain.addEventListener('input', () => { this.fill(); this.render(); });
    controls.follow.addEventListener('input', () => this.followCamera());
    const dark = window.matchMedia('(prefers-color-scheme: dark)');
    dark.addEventListener('change', () => { this.recolour(); this.fill(); this.render(); });
    new ResizeObserver(() => this.resize()).observe(host);
    this.recolour();
    this.resize();
  }

  build(canvas) {
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(50, 4 / 3, 0.01, 1000);
    this.camera.up.set(...FIRST_UP);
    this.camera.position.set(0, -3, -6);
    this.orbit = this.orbitOn(canvas);
    canvas.addEventListener('keydown', (event) => this.turnByKey(event));
    this.points = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ size: 2 * (window.devicePixelRatio || 1), sizeAttenuation: false, vertexColors: THREE.VertexColors }));
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ vertexColors: THREE.VertexColors }));
    this.straight = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
    this.way = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
    this.frusta = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ transparent: true, opacity: 0.5 }));
    this.recent = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
    this.now = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
    for (const drawn of [this.points, this.lines, this.straight, this.way, this.frusta, this.recent, this.now]) {
      drawn.frustumCulled = false;
      setPositions(drawn.geometry, []);
      this.scene.add(drawn);
    }
  }

  // Turns about the camera's up as it is now.
  orbitOn(canvas) {
    const orbit = new THREE.OrbitControls(this.camera, canvas);
    orbit.enableKeys = false;
    orbit.addEventListener('start', () => { this.touched = true; });
    orbit.addEventListener('change', () => this.render());
    return orbit;
  }

  // `up`: unit length, in the map's frame; null: nothing says it.
  setUp(up) {
    if (!this.renderer) return;
    const wanted = new THREE.Vector3(...(up || FIRST_UP));
    if (this.camera.up.angleTo(wanted) < LEAST_TURN) return;
    this.camera.up.copy(wanted);
    const target = this.orbit.target.clone();
    this.orbit.dispose();
    this.orbit = this.orbitOn(this.renderer.domElement);
    this.orbit.target.copy(target);
    this.orbit.update();
    if (!this.touched) this.fit(); else this.render();
  }

  // Of the image, at distance 1.
  setCamera(camera) {
    this.corners = camera.fx > 0 && camera.fy > 0
      ? [[0, 0], [camera.width, 0], [camera.width, camera.height], [0, camera.height]].map(([u, v]) => [(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy])
      : [[-0.6, -0.45], [0.6, -0.45], [0.6, 0.45], [-0.6, 0.45]];
  }

  show(description, rest) {
    if (!this.renderer) return;
    const before = this.map;
    this.map = readMap(description, rest, before);
    if (before && before.world !== this.map.world) this.touched = false; // another map has other coordinates
    this.host.querySelector('.empty').hidden = this.map.count > 0;
    if (this.map.count === 0) this.touched = false;
    this.measure();
    this.fill();
    this.drawKeyframes();
    if (!this.touched) this.fit(); else this.render();
  }

  // Middle and size of what is known well, with every keyframe in it.
  measure() {
    const { count, positions, sigmas, keyframes } = this.map;
    const extents = [0, 1, 2].map((axis) => {
      const known = [];
      for (let i = 0; i < count; ++i) if (sigmas[i] <= MOST_CERTAIN) known.push(positions[3 * i + axis]);
      let [low, high] = known.length ? [quantile(known, 0.05), quantile(known, 0.95)] : [Infinity, -Infinity];
      for (let i = axis; i < keyframes.length; i += 7) [low, high] = [Math.min(low, keyframes[i]), Math.max(high, keyframes[i])];
      return low <= high ? [low, high] : [0, 0];
    });
    this.centre = new THREE.Vector3(...extents.map(([low, high]) => (low + high) / 2));
    this.radius = Math.max(1e-3, Math.hypot(...extents.map(([low, high]) => (high - low) / 2)));
  }

  fill() {
    if (!this.map) return;
    const { count, positions, greys, sigmas, joins, straight } = this.map;
    const dark = window.matchMedia('(prefers-color-scheme: dark)').matches;
    const bound = this.controls.uncertain.checked ? 255 : MOST_CERTAIN;
    const colours = new Float32Array(3 * count);
    const shown = [];
    const segments = [];
    for (let i = 0; i < count; ++i) {
      const grey = greys[i] / 255;
      colours.fill(dark ? 0.4 + 0.6 * grey : 0.02 + 0.5 * grey, 3 * i, 3 * i + 3);
      if (sigmas[i] > bound) continue;
      shown.push(i);
      if (joins[i] && i > 0 && sigmas[i - 1] <= bound && this.near(i)) segments.push(i - 1, i);
    }
    for (const drawn of [this.points, this.lines]) {
      setPositions(drawn.geometry, positions);
      drawn.geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
    }
    this.points.geometry.setIndex(shown);
    this.lines.geometry.setIndex(segments);
    setPositions(this.straight.geometry, straight);
    this.shownPoints = shown.length;
  }

  // Neighbours on one edge of the image may lie far behind each other.
  near(i) {
    const p = this.map.positions;
    return Math.hypot(p[3 * i] - p[3 * i - 3], p[3 * i + 1] - p[3 * i - 2], p[3 * i + 2] - p[3 * i - 1]) < 0.15 * this.radius;
  }

  // Segments of a camera's pyramid; `pose`: position and rotation as arrays, `depth` of its image.
  frustum(pose, depth) {
    const centre = new THREE.Vector3(...pose.position);
    const rotation = new THREE.Quaternion(...pose.rotation);
    const ends = [centre, ...this.corners.map(([x, y]) => new THREE.Vector3(x, y, 1).multiplyScalar(depth).applyQuaternion(rotation).add(centre))];
    return FRUSTUM_LINES.flatMap(([a, b]) => [ends[a].x, ends[a].y, ends[a].z, ends[b].x, ends[b].y, ends[b].z]);
  }

  drawKeyframes() {
    const { keyframes } = this.map;
    const way = [];
    const frusta = [];
    for (let i = 0; i < keyframes.length; i += 7) {
      way.push(...keyframes.subarray(i, i + 3));
      frusta.push(...this.frustum({ position: keyframes.subarray(i, i + 3), rotation: keyframes.subarray(i + 3, i + 7) }, 0.045 * this.radius));
    }
    setPositions(this.way.geometry, way);
    setPositions(this.frusta.geometry, frusta);
  }

  // `measured` may be null. `time` [s]. `world`: that the pose is in; one that the map shown is not of is not drawn.
  moveCamera(measured, time, state, world) {
    if (!this.renderer || !this.corners) return;
    const pose = measured && (!this.map || this.map.count === 0 || this.map.world === world) ? measured : null;
    const last = this.tail[this.tail.length - 1];
    if (state === 'initialising' || (last && time < last.time)) this.tail = [];
    this.tail = this.tail.filter((entry) => entry.time > time - TAIL_SECONDS && (!measured || entry.world === world));
    if (pose && isMeasured(state)) this.tail.push({ time, world, position: pose.position });
    setPositions(this.recent.geometry, this.tail.flatMap((entry) => entry.position));
    setPositions(this.now.geometry, pose ? this.frustum(pose, 0.1 * (this.radius || 1)) : []);
    this.pose = pose;
    this.followCamera();
    this.render();
  }

  followCamera() {
    if (!this.controls.follow.checked || !this.pose) return;
    const step = new THREE.Vector3(...this.pose.position).sub(this.orbit.target).multiplyScalar(0.3);
    this.orbit.target.add(step);
    this.camera.position.add(step);
    this.orbit.update();
  }

  // From behind the first camera and above it, so that all is in view.
  fit() {
    if (!this.renderer || !this.radius) return;
    const upright = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(...FIRST_UP), this.camera.up);
    const back = new THREE.Vector3(-0.45, -0.75, -1).normalize().applyQuaternion(upright);
    const distance = 0.95 * this.radius / Math.sin(25 * Math.PI / 180) * Math.max(1, 1.2 / this.camera.aspect);
    this.camera.near = 1e-3 * this.radius;
    this.camera.far = 100 * this.radius;
    this.camera.updateProjectionMatrix();
    this.orbit.target.copy(this.centre);
    this.camera.position.copy(this.centre).addScaledVector(back, distance);
    this.orbit.update();
    this.render();
  }

  turnByKey(event) {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    const zooms = { '+': 0.9, '=': 0.9, '-': 1 / 0.9 };
    if (!(event.key in turns) && !(event.key in zooms)) return;
    event.preventDefault();
    this.touched = true;
    const offset = this.camera.position.clone().sub(this.orbit.target);
    if (event.key in zooms) {
      offset.multiplyScalar(zooms[event.key]);
    } else {
      const upright = new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0));
      const place = new THREE.Spherical().setFromVector3(offset.applyQuaternion(upright));
      place.theta += turns[event.key][0];
      place.phi += turns[event.key][1];
      place.makeSafe();
      offset.setFromSpherical(place).applyQuaternion(upright.clone().inverse());
    }
    this.camera.position.copy(this.orbit.target).add(offset);
    this.orbit.update();
    this.render();
  }

  recolour() {
    const colour = (name) => new THREE.Color(cssText(name));
    this.scene.background = colour('--page');
    this.straight.material.color.copy(colour('--tracking'));
    this.way.material.color.copy(colour('--way'));
    this.frusta.material.color.copy(colour('--way'));
    this.recent.material.color.copy(colour('--live'));
    this.now.material.color.copy(colour('--live'));
  }

  resize() {
    if (this.host.clientWidth === 0) return;
    this.renderer.setSize(this.host.clientWidth, this.host.clientHeight, false);
    this.camera.aspect = this.host.clientWidth / this.host.clientHeight;
    this.camera.updateProjectionMatrix();
    if (!this.touched) this.fit();
    this.render();
  }

  render() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.renderer.render(this.scene, this.camera); });
  }
}

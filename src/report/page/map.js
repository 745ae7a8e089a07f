// The map in three dimensions, to turn with the mouse: edges as lines, the camera's way, the keyframes' frusta.

function cssColour(name) {
  return new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
}

function quantile(values, share) {
  const sorted = Float64Array.from(values).sort();
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : 0;
}

// Points and segments in order of their depth's uncertainty, so that a threshold is a number of them to draw.
function readMap(map) {
  const count = map.greys.length;
  const position = new Float32Array(3 * count);
  for (let i = 0; i < 3 * count; ++i) position[i] = map.positions[i] * map.step;
  const chain = new Int32Array(count);
  const segments = [];
  let first = 0;
  map.lines.forEach((length, line) => {
    for (let i = first; i < first + length; ++i) {
      chain[i] = map.chains[line];
      if (i > first) segments.push([i - 1, i]);
    }
    first += length;
  });
  const sigma = map.sigmas_permille;
  const ofSegment = (pair) => Math.max(sigma[pair[0]], sigma[pair[1]]);
  segments.sort((p, q) => ofSegment(p) - ofSegment(q));
  const points = Array.from({ length: count }, (unused, i) => i).sort((p, q) => sigma[p] - sigma[q]);
  return { count, position, chain, points, segments, pointSigmas: points.map((i) => sigma[i]), segmentSigmas: segments.map(ofSegment) };
}

function countBelow(sorted, bound) {
  let low = 0;
  let high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] <= bound) low = middle + 1; else high = middle;
  }
  return low;
}

// Where to look from: above and behind the camera's way, at the middle of the map.
function viewpoint(map, trajectory) {
  const middle = (positions, share) => new THREE.Vector3(...[0, 1, 2].map((axis) => {
    const values = [];
    for (let i = axis; i < positions.length; i += 3) values.push(positions[i]);
    return quantile(values, share);
  }));
  const all = map.count ? map.position : trajectory;
  const centre = middle(all, 0.5);
  const way = trajectory.length ? middle(trajectory, 0.5) : centre.clone();
  const distances = [];
  const point = new THREE.Vector3();
  for (const positions of [all, trajectory]) {
    for (let i = 0; i + 2 < positions.length; i += 3) distances.push(point.set(positions[i], positions[i + 1], positions[i + 2]).distanceTo(centre));
  }
  const radius = Math.max(quantile(distances, 0.85), 1e-3);
  const back = way.clone().sub(centre).setZ(0);
  if (back.length() < 0.15 * radius) back.set(-0.5, -0.85, 0);
  back.normalize();
  const side = new THREE.Vector3(-back.y, back.x, 0);
  const target = centre.clone().lerp(way, 0.3);
  const from = target.clone().addScaledVector(back, 1.5 * radius).addScaledVector(side, 0.5 * radius);
  from.z += 0.7 * radius;
  return { target, from, radius };
}

function lineOf(positions, colour) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  return new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: colour }));
}

// All keyframes' frusta as segments; `depth` is the distance of the drawn image from the camera's centre.
function frustaOf(run, depth) {
  const camera = run.camera;
  const corners = camera.fx > 0 && camera.fy > 0
    ? [[0, 0], [camera.width, 0], [camera.width, camera.height], [0, camera.height]].map(([u, v]) => [(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy])
    : [[-0.6, -0.45], [0.6, -0.45], [0.6, 0.45], [-0.6, 0.45]];
  const positions = [];
  for (const keyframe of run.keyframes) {
    const centre = new THREE.Vector3(...keyframe.position);
    const rotation = new THREE.Quaternion(...keyframe.rotation);
    const image = corners.map(([x, y]) => new THREE.Vector3(x, y, 1).multiplyScalar(depth).applyQuaternion(rotation).add(centre));
    image.forEach((corner, i) => {
      const next = image[(i + 1) % 4];
      positions.push(centre.x, centre.y, centre.z, corner.x, corner.y, corner.z, corner.x, corner.y, corner.z, next.x, next.y, next.z);
    });
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 }));
}

// Draws `run` into `host`; controls: {colour, sigma, sigmaValue, lines, frusta, reset, caption} are elements of the page.
function mapView(host, run, controls, cursor) {
  if (run.map.shown === 0 && run.trajectory.times.length === 0) {
    host.innerHTML = '<p class="notice">The map is empty: there is nothing to draw.</p>';
    return;
  }
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true });
  } catch (error) {
    host.innerHTML = '<p class="notice">This browser offers no WebGL, which the 3D map needs. map.ply beside this file holds the same points.</p>';
    return;
  }
  const map = readMap(run.map);
  const trajectory = run.trajectory.positions;
  const view = viewpoint(map, trajectory);
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  renderer.setPixelRatio(window.devicePixelRatio || 1);
  host.replaceChildren(renderer.domElement);
  renderer.domElement.setAttribute('role', 'img');
  renderer.domElement.setAttribute('aria-label', `3D map of ${run.map.points} edge points with the camera's trajectory`);

  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(50, 1, view.radius * 1e-3, view.radius * 200);
  camera.up.set(0, 0, 1);
  const orbit = new THREE.OrbitControls(camera, renderer.domElement);

  const pointGeometry = new THREE.BufferGeometry();
  pointGeometry.setAttribute('position', new THREE.BufferAttribute(map.position, 3));
  pointGeometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * map.count), 3));
  const lineGeometry = pointGeometry.clone();
  pointGeometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(map.points), 1));
  lineGeometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(map.segments.flat()), 1));
  lineGeometry.setAttribute('color', pointGeometry.getAttribute('color'));
  const points = new THREE.Points(pointGeometry, new THREE.PointsMaterial({ size: 2 * (window.devicePixelRatio || 1), sizeAttenuation: false, vertexColors: THREE.VertexColors }));
  const lines = new THREE.LineSegments(lineGeometry, new THREE.LineBasicMaterial({ vertexColors: THREE.VertexColors }));
  const straightGeometry = new THREE.BufferGeometry();
  straightGeometry.setAttribute('position', new THREE.Float32BufferAttribute(run.map.straight.map((number) => number * run.map.step), 3));
  const straight = new THREE.LineSegments(straightGeometry, new THREE.LineBasicMaterial());
  const way = lineOf(trajectory, 0);
  const truth = lineOf(run.truth ? run.truth.positions : [], 0);
  const frusta = frustaOf(run, 0.05 * view.radius);
  const mark = new THREE.Mesh(new THREE.SphereGeometry(0.018 * view.radius, 16, 12), new THREE.MeshBasicMaterial());
  mark.visible = false;
  for (const drawn of [points, lines, straight, way, truth, frusta, mark]) drawn.frustumCulled = false;
  scene.add(points, lines, straight, truth, way, frusta, mark);

  let pending = false;
  const render = () => {
    if (pending) return;
    pending = true;
    requestAnimationFrame(() => { pending = false; renderer.render(scene, camera); });
  };

  const heights = [];
  for (let i = 2; i < map.position.length; i += 3) heights.push(map.position[i]);
  const lowest = quantile(heights, 0.03);
  const highest = Math.max(quantile(heights, 0.97), lowest + 1e-9);
  const recolour = () => {
    const mode = controls.colour.value;
    const colours = pointGeometry.getAttribute('color');
    const colour = new THREE.Color();
    for (let i = 0; i < map.count; ++i) {
      if (mode === 'chain' && map.chain[i] >= 0) {
        colour.setHSL((map.chain[i] * 0.618034) % 1, 0.6, dark.matches ? 0.62 : 0.4);
      } else if (mode === 'height') {
        const share = Math.min(1, Math.max(0, (heights[i] - lowest) / (highest - lowest)));
        colour.setHSL(0.68 - 0.6 * share, 0.7, dark.matches ? 0.6 : 0.42);
      } else {
        const grey = mode === 'grey' ? run.map.greys[i] / 255 : 0.5;
        colour.setScalar(dark.matches ? 0.35 + 0.65 * grey : 0.05 + 0.6 * grey);
      }
      colours.setXYZ(i, colour.r, colour.g, colour.b);
    }
    colours.needsUpdate = true;
    scene.background = cssColour('--surface');
    way.material.color.copy(cssColour('--estimate'));
    truth.material.color.copy(cssColour('--truth'));
    straight.material.color.copy(cssColour('--live'));
    frusta.material.color.copy(cssColour('--keyframe'));
    mark.material.color.copy(cssColour('--cursor'));
    render();
  };
  const choose = () => {
    const bound = Number(controls.sigma.value);
    const shown = countBelow(map.pointSigmas, 10 * bound);
    pointGeometry.setDrawRange(0, shown);
    lineGeometry.setDrawRange(0, 2 * countBelow(map.segmentSigmas, 10 * bound));
    lines.visible = straight.visible = controls.lines.checked;
    frusta.visible = controls.frusta.checked;
    controls.sigmaValue.textContent = bound >= 100 ? 'all' : bound + ' %';
    const thinned = run.map.shown < run.map.points ? ` (thinned from ${run.map.points.toLocaleString('en')} to keep the page small)` : '';
    const straightEdges = run.map.straight.length / 6;
    controls.caption.textContent = `${shown.toLocaleString('en')} of ${run.map.shown.toLocaleString('en')} map points${thinned}; neighbours along an image edge ` +
      `are joined${straightEdges ? `; orange: ${straightEdges.toLocaleString('en')} lines` : ''}. Drag to turn, wheel to come nearer, right button to shift. Blue: the camera's way` +
      `${run.truth ? '; grey: ground truth' : ''}. Up is ${run.axes[2]}${run.aligned ? ' of the ground truth' : ' of the first keyframe'}.`;
    render();
  };
  const reset = () => {
    // A narrow window needs more distance for the same width.
    const distance = Math.max(1, 1.5 / camera.aspect);
    camera.position.copy(view.target).lerp(view.from, distance);
    orbit.target.copy(view.target);
    orbit.update();
    render();
  };
  const resize = () => {
    if (host.clientWidth === 0) return;
    renderer.setSize(host.clientWidth, host.clientHeight);
    camera.aspect = host.clientWidth / host.clientHeight;
    camera.updateProjectionMatrix();
    render();
  };
  cursor.listen(host, (time) => {
    const i = time === null ? -1 : nearestIndex(run.trajectory.times, time);
    if (i < 0 && !mark.visible) return;
    mark.visible = i >= 0;
    if (i >= 0) mark.position.set(trajectory[3 * i], trajectory[3 * i + 1], trajectory[3 * i + 2]);
    render();
  });
  controls.colour.addEventListener('change', recolour);
  for (const control of [controls.sigma, controls.lines, controls.frusta]) control.addEventListener('input', choose);
  controls.reset.addEventListener('click', reset);
  if (dark.addEventListener) dark.addEventListener('change', recolour);
  orbit.addEventListener('change', render);
  new ResizeObserver(resize).observe(host);
  resize();
  recolour();
  choose();
  reset();
}

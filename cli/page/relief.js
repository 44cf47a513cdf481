// Terrain in 3-D with the selected layer and the routes, drawn by three.js, which is loaded at the first use.
// Axes: metres east, up and south of the map's centre; the page states the vertical exaggeration.
function offerRelief(data, explain) {
  const button = document.getElementById("solid"), place = document.getElementById("relief");
  const text = document.getElementById("three");
  const elevation = data.layers.find(layer => layer.name === "elevation");
  if (!text || !elevation) return;
  button.hidden = false;
  let relief = null;
  button.addEventListener("click", async () => {
    const on = place.hidden;
    place.hidden = !on;
    document.body.classList.toggle("solid", on);
    document.getElementById("heights").hidden = !on;
    button.setAttribute("aria-pressed", on);
    if (!on) return;
    const canvas = document.createElement("canvas");
    const context = relief || canvas.getContext("webgl", {preserveDrawingBuffer: true, antialias: false, stencil: true});
    if (!context) {
      place.firstElementChild.textContent = "No relief: this browser has no WebGL.";
      place.dataset.state = "no WebGL";
      return;
    }
    if (!relief) {
      document.head.appendChild(document.createElement("script")).textContent = text.textContent;
      const values = await words(elevation.values, data.grid.width, data.grid.height);
      relief = await makeRelief(place, data, heightsOf(data, values, elevation), {canvas, context}, explain);
    }
    relief.fit();
    place.dataset.state = "ready";
  });
}

// Largest number of points per side, few enough for immediate drawing without a graphics card.
const reliefSide = 256;

// Heights [m] of every stride-th cell from the north-west; null for cells without data.
function heightsOf(data, values, {low, decimals}) {
  const {width, height, cell} = data.grid, stride = Math.max(1, Math.ceil(Math.max(width, height) / reliefSide));
  const columns = Math.ceil(width / stride), rows = Math.ceil(height / stride);
  const at = (column, row) => {
    const word = values[Math.min(row * stride, height - 1) * width + Math.min(column * stride, width - 1)];
    return word === 0 ? null : (low + word - 1) / 10 ** decimals;
  };
  const z = Array.from({length: columns * rows}, (_, i) => at(i % columns, Math.floor(i / columns)));
  const known = z.filter(value => value !== null);
  const least = known.reduce((a, b) => Math.min(a, b), Infinity);
  const most = known.reduce((a, b) => Math.max(a, b), -Infinity);
  return {columns, rows, step: stride * cell, z, middle: (least + most) / 2, range: most - least};
}

function groundGeometry(heights, data) {
  const {columns, rows, step, z, middle} = heights, {width, height, cell} = data.grid;
  const positions = [], uvs = [], indices = [];
  for (let row = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column) {
      const x = Math.min(column * step, (width - 1) * cell) + cell / 2;
      const y = Math.min(row * step, (height - 1) * cell) + cell / 2;
      const up = z[row * columns + column];
      positions.push(x - width * cell / 2, up === null ? 0 : up - middle, y - height * cell / 2);
      uvs.push(x / (width * cell), 1 - y / (height * cell));
    }
  const known = i => z[i] !== null;
  for (let row = 0; row + 1 < rows; ++row)
    for (let column = 0; column + 1 < columns; ++column) {
      const a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
      if ([a, b, c, d].every(known)) indices.push(a, c, b, b, c, d);
    }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute("uv", new THREE.Float32BufferAttribute(uvs, 2));
  geometry.setIndex(new THREE.Uint32BufferAttribute(indices, 1));
  return geometry;
}

// The selected layer as on the map: drawn with its opacity over the hillshade, then multiplied by the
// hillshade.
async function groundTexture(data) {
  const image = uri => new Promise(done => {
    const made = new Image();
    made.onload = () => done(made);
    made.src = uri;
  });
  const layer = data.layers[document.getElementById("layer").value];
  const {width, height} = data.grid, scale = Math.min(4, Math.max(1, Math.floor(1024 / Math.max(width, height))));
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d", {willReadFrequently: true});
  canvas.width = width * scale;
  canvas.height = height * scale;
  context.imageSmoothingEnabled = false;
  const shade = await image(data.shade);
  context.drawImage(shade, 0, 0, canvas.width, canvas.height);
  if (layer) {
    context.globalAlpha = document.getElementById("opacity").value / 100;
    context.drawImage(await image(layer.image), 0, 0, canvas.width, canvas.height);
    context.globalAlpha = Math.max(layer.relief, 0.3);  // unlit: only the shading shows the terrain
    context.globalCompositeOperation = "multiply";
    context.filter = lightFilter(data.light);
    context.drawImage(shade, 0, 0, canvas.width, canvas.height);
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.minFilter = THREE.LinearFilter;
  texture.generateMipmaps = false;
  return texture;
}

// A label that faces the camera.
function letterAt(letter, size) {
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d", {willReadFrequently: true});
  canvas.width = canvas.height = 64;
  context.fillStyle = "#1b3fbf";
  context.textAlign = "center";
  context.strokeStyle = "#fff";
  context.lineWidth = 6;
  context.beginPath();
  context.arc(32, 32, 28, 0, 2 * Math.PI);
  context.fill();
  context.stroke();
  context.fillStyle = "#fff";
  context.font = "bold 34px sans-serif";
  context.fillText(letter, 32, 44);
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({map: new THREE.CanvasTexture(canvas), depthTest: false}));
  sprite.scale.set(size, size, 1);
  return sprite;
}

// A route as a tube in the colours of its quantity, raised by its radius, with a rim and labels at both ends.
function routeInSpace({points, colour: rim}, colours, spot, extent) {
  const group = new THREE.Group(), most = 600, radius = extent / 320;
  const chosen = points.length <= most ? points.map((_, i) => i)
    : Array.from({length: most}, (_, i) => Math.round(i * (points.length - 1) / (most - 1)));
  const distinct = chosen.filter((k, i) => i === 0 || points[k].s > points[chosen[i - 1]].s);
  const lift = new THREE.Vector3(0, radius, 0);
  if (distinct.length > 1) {
    const curve = new THREE.CatmullRomCurve3(distinct.map(k => spot(points[k]).add(lift)), false, "centripetal");
    const pieces = 2 * distinct.length, around = 6, tube = new THREE.TubeBufferGeometry(curve, pieces, radius, around);
    const length = points[distinct[distinct.length - 1]].s, parts = [];
    for (let i = 0; i <= pieces; ++i) {
      const k = points.indexOf(pointAt(points, length * i / pieces)), colour = new THREE.Color(colours[k]);
      for (let j = 0; j <= around; ++j) parts.push(colour.r, colour.g, colour.b);
    }
    tube.setAttribute("color", new THREE.Float32BufferAttribute(parts, 3));
    group.add(new THREE.Mesh(tube, new THREE.MeshBasicMaterial({vertexColors: THREE.VertexColors})));
    const wider = new THREE.TubeBufferGeometry(curve, pieces, 1.7 * radius, around);  // drawn as a rim
    group.add(new THREE.Mesh(wider, new THREE.MeshBasicMaterial({color: rim, side: THREE.BackSide})));
  }
  for (const [p, letter] of [[points[0], "S"], [points[points.length - 1], "G"]]) {
    const sprite = letterAt(letter, extent / 28);
    sprite.position.copy(spot(p)).add(new THREE.Vector3(0, extent / 45, 0));
    group.add(sprite);
  }
  return group;
}

// A click without dragging explains the cell under the pointer, as on the map.
function explainOnClick({grid, bounds}, {renderer, camera, ground}, explain) {
  let from = null;
  renderer.domElement.addEventListener("pointerdown", event => { from = event; });
  renderer.domElement.addEventListener("click", event => {
    if (from && Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > 4) return;
    const view = renderer.domElement.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera({x: 2 * (event.clientX - view.left) / view.width - 1, y: 1 - 2 * (event.clientY - view.top) / view.height}, camera);
    const [hit] = ray.intersectObject(ground);
    if (!hit) return;
    const {cell, width, height} = grid, inside = (at, count) => Math.min(Math.max(Math.floor(at / cell), 0), count - 1);
    explain(inside(hit.point.x + (bounds.east - bounds.west) / 2, width),
            inside((bounds.north - bounds.south) / 2 - hit.point.z, height));
  });
}

// Builds the relief view and returns {fit()}, which adapts the view to the size of its element.
async function makeRelief(place, data, heights, surface, explain) {
  const {west, south, east, north} = data.bounds;
  const extent = Math.max(east - west, north - south), note = place.firstElementChild;
  const renderer = new THREE.WebGLRenderer(surface);
  renderer.setClearColor(0xdfe6ee);
  place.insertBefore(renderer.domElement, note);
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(40, 1, extent / 1000, 20 * extent);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  let waiting = false;
  const render = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      renderer.render(scene, camera);
      place.dataset.drawn = 1 + +(place.dataset.drawn || 0);
    });
  };
  controls.addEventListener("change", render);
  const ground = new THREE.Mesh(groundGeometry(heights, data), new THREE.MeshBasicMaterial({side: THREE.DoubleSide}));
  scene.add(ground);
  const slider = document.getElementById("exaggeration");
  slider.value = Math.min(10, Math.max(1, Math.round(0.12 * extent / Math.max(heights.range, 1e-9))));
  let routes = new THREE.Group();

  async function paint() {
    if (ground.material.map) ground.material.map.dispose();
    ground.material.map = await groundTexture(data);
    ground.material.needsUpdate = true;
    render();
  }
  function raise() {
    const factor = +slider.value;
    document.getElementById("factor").textContent = factor;
    note.textContent = `vertical exaggeration ${factor} × · ${heights.range.toFixed(0)} m of relief over ` +
      `${((east - west) / 1000).toPrecision(3)} km · first view from the south`;
    ground.scale.y = factor;
    scene.remove(routes);
    routes = new THREE.Group();
    const spot = p => new THREE.Vector3(p.x - (west + east) / 2, factor * (p.elevation - heights.middle),
                                        (south + north) / 2 - p.y);
    const drawn = data.routes.filter(({points}) => points.every(p => p.elevation !== null));
    const {colours} = coloursOf(quantities[document.getElementById("quantity").value || 0], data);
    for (const route of drawn) routes.add(routeInSpace(route, colours[data.routes.indexOf(route)], spot, extent));
    scene.add(routes);
    render();
  }
  function fit() {
    if (!place.clientWidth) return;
    renderer.setSize(place.clientWidth, place.clientHeight);
    camera.aspect = place.clientWidth / place.clientHeight;
    camera.updateProjectionMatrix();
    render();
  }
  slider.addEventListener("input", raise);
  document.getElementById("quantity").addEventListener("change", raise);
  for (const id of ["layer", "opacity"]) document.getElementById(id).addEventListener("change", paint);
  addEventListener("resize", fit);
  explainOnClick(data, {renderer, camera, ground}, explain);
  const away = 1.7 * extent / Math.min(1, place.clientWidth / place.clientHeight);  // shows all
  camera.position.set(0, 0.6 * away, 0.8 * away);
  controls.update();
  await paint();
  fit();
  raise();
  return {fit};
}

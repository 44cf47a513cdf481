// Terrain in 3-D under the selected layer and the routes, drawn by three.js, which is loaded at the first use.
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
// hillshade; over it the routes.
async function groundTexture(data) {
  const layer = data.layers[document.getElementById("layer").value];
  const {width, height} = data.grid, scale = Math.max(1, Math.floor(1200 / Math.max(width, height)));
  const context = contextOf(width * scale, height * scale), canvas = context.canvas;
  context.imageSmoothingEnabled = false;
  const shade = await loaded(data.shade);
  context.drawImage(shade, 0, 0, canvas.width, canvas.height);
  if (layer) {
    context.globalAlpha = document.getElementById("opacity").value / 100;
    context.drawImage(await loaded(layer.image), 0, 0, canvas.width, canvas.height);
    context.globalAlpha = Math.max(layer.relief, 0.3);  // unlit: only the shading shows the terrain
    context.globalCompositeOperation = "multiply";
    context.filter = lightFilter(data.light);
    context.drawImage(shade, 0, 0, canvas.width, canvas.height);
  }
  Object.assign(context, {globalAlpha: 1, globalCompositeOperation: "source-over", filter: "none"});
  const {west, south, east, north} = data.bounds;
  const spot = p => [(p.x - west) / (east - west) * canvas.width, (north - p.y) / (north - south) * canvas.height];
  const {colours} = coloursOf(quantities[document.getElementById("quantity").value || 0], data);
  data.routes.forEach(({points, colour}, k) => drawWay(context, points.map(spot), colours[k], colour));
  const texture = new THREE.CanvasTexture(canvas);
  texture.minFilter = THREE.LinearFilter;
  texture.generateMipmaps = false;
  return texture;
}

// Draws a route with a rim, in the colours of its quantity, and its ends.
function drawWay(context, spots, colours, rim) {
  const width = Math.max(context.canvas.width, context.canvas.height) / 200, last = spots.length - 1;
  const stroke = (line, colour, share) => {
    context.strokeStyle = colour;
    context.lineWidth = share * width;
    context.stroke(new Path2D("M" + line.map(spot => spot.join()).join("L")));
  };
  context.lineJoin = context.lineCap = "round";
  stroke(spots, rim, 2.2);
  stroke(spots, "#fff", 1.6);
  spots.slice(1).forEach((spot, i) => stroke([spots[i], spot], colours[i], 1));
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = `bold ${3 * width}px sans-serif`;
  for (const [[x, y], letter] of [[spots[0], "S"], [spots[last], "G"]]) {
    stroke([[x, y], [x, y + 0.01]], "#fff", 6);
    stroke([[x, y], [x, y + 0.01]], "#1b3fbf", 5);
    context.fillStyle = "#fff";
    context.fillText(letter, x, y);
  }
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
  for (const id of ["layer", "opacity", "quantity"]) document.getElementById(id).addEventListener("change", paint);
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

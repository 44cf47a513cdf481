// The map in metres (CRS.Simple): hillshade, shaded layer, north arrow, scale bar, coordinates at the cursor.
function drawMap(element, data) {
  const b = data.bounds;
  const box = L.latLngBounds([[b.south, b.west], [b.north, b.east]]);
  const map = L.map(element, {crs: L.CRS.Simple, minZoom: -20, maxZoom: 8, zoomSnap: 0, attributionControl: false});
  L.control.scale({imperial: false, maxWidth: 140}).addTo(map);
  showNorth(map);
  if (canHover) showCursor(map, data);
  L.imageOverlay(data.shade, box, {alt: "hillshade", zIndex: 1}).addTo(map);
  firstView(map, data);
  chooseLayer(map, data, box);
  for (const {name, image} of data.areas) L.imageOverlay(image, box, {alt: name, zIndex: 4}).addTo(map);
  const hatched = colour => `repeating-linear-gradient(135deg, ${colour} 0 2px, #fff 2px 5px)`;
  if (data.areas.length)
    showLegend("areas", {name: "hatched", legend: data.areas.map(({name, colour}) => ({label: name, colour: hatched(colour)}))});
  for (const {letter, x, y} of data.marks) showEnd(map, [y, x], letter);
  for (const {x, y, radius, label} of data.rings) {
    const size = 2 * Math.max(18, radius * map.getZoomScale(map.getZoom(), 0) + 12);
    L.marker([y, x], {interactive: false, icon: L.divIcon({className: "ring", iconSize: [size, size]})}).addTo(map)
      .bindTooltip(document.createTextNode(label), {permanent: true, direction: "top", offset: [0, -size / 2]});
  }
  return map;
}

// Points that the first view must show: routes, or track and planned routes of a drive.
function wayOf(data) {
  if (!data.story) return data.routes.flatMap(route => route.points);
  const planned = data.story.events.flatMap(event => event.route);
  return [...data.story.track.map(([, x, y]) => ({x, y})), ...planned.map(([x, y]) => ({x, y}))];
}

// Sets the largest zoom that shows all points beside the controls of the map, shifted so that little area outside
// the map is visible.
function firstView(map, data) {
  const b = data.bounds, box = L.latLngBounds([[b.south, b.west], [b.north, b.east]]);
  const points = wayOf(data).map(p => [p.y, p.x]), way = points.length ? L.latLngBounds(points) : box;
  const [top, bottom, side] = points.length ? [70, 44, 16] : [0, 0, 0];  // [pixels]
  const zoom = map.getBoundsZoom(way, false, L.point(2 * side, top + bottom)), scale = map.getZoomScale(zoom, 0);
  const size = map.getSize(), centre = way.getCenter();
  const within = (at, low, high, half) =>
    high - low <= 2 * half ? (low + high) / 2 : Math.min(Math.max(at, low + half), high - half);
  map.setView([within(centre.lat + (top - bottom) / scale / 2, b.south - bottom / scale, b.north + top / scale, size.y / scale / 2),
               within(centre.lng, b.west - side / scale, b.east + side / scale, size.x / scale / 2)], zoom, {animate: false});
}

function showEnd(map, place, letter) {
  const dot = document.createElement("span");
  dot.textContent = letter;
  const icon = L.divIcon({className: "end", html: dot, iconSize: [22, 22]});
  L.marker(place, {interactive: false, keyboard: false, icon}).addTo(map);
}

// Adds a box in a corner of the map, whose clicks the map ignores.
function cornerBox(map, position, className) {
  const control = L.control({position});
  control.onAdd = () => L.DomUtil.create("div", className);
  control.addTo(map);
  L.DomEvent.disableClickPropagation(control.getContainer());
  return control.getContainer();
}

function showNorth(map) {
  const box = cornerBox(map, "topright", "north");
  box.title = "north of the map";
  box.innerHTML = '<svg width="26" height="40" viewBox="0 0 26 40" role="img" aria-label="north is up">' +
    '<path d="M13 14 L22 38 L13 32 L4 38 Z" fill="#222" stroke="#fff"/>' +
    '<text x="13" y="12" text-anchor="middle">N</text></svg>';
}

// Latitude and longitude [deg] from the directions (unit vectors) of the lattice points, interpolated
// bilinearly.
function geographic(places, bounds, x, y) {
  if (!places) return null;
  const n = places.intervals, rad = Math.PI / 180;
  const u = (x - bounds.west) / (bounds.east - bounds.west) * n;
  const v = (y - bounds.south) / (bounds.north - bounds.south) * n;
  const i = Math.min(Math.max(Math.floor(u), 0), n - 1), j = Math.min(Math.max(Math.floor(v), 0), n - 1);
  const sum = [0, 0, 0];
  for (const [di, dj] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
    const k = (j + dj) * (n + 1) + i + di, weight = (di ? u - i : 1 - u + i) * (dj ? v - j : 1 - v + j);
    if (places.latitude[k] === null) return null;
    const latitude = places.latitude[k] * rad, longitude = places.longitude[k] * rad;
    sum[0] += weight * Math.cos(latitude) * Math.cos(longitude);
    sum[1] += weight * Math.cos(latitude) * Math.sin(longitude);
    sum[2] += weight * Math.sin(latitude);
  }
  return {latitude: Math.atan2(sum[2], Math.hypot(sum[0], sum[1])) / rad, longitude: Math.atan2(sum[1], sum[0]) / rad};
}

function placeText(data, x, y) {
  const at = geographic(data.places, data.bounds, x, y);
  const metres = `x ${x.toFixed(1)} m, y ${y.toFixed(1)} m`;
  return at ? `${metres} · lat ${at.latitude.toFixed(5)}°, lon ${at.longitude.toFixed(5)}°` : metres;
}

function showCursor(map, data) {
  const box = cornerBox(map, "bottomleft", "cursor");
  box.hidden = true;
  map.on("mousemove", ({latlng}) => {
    box.hidden = false;
    box.textContent = placeText(data, latlng.lng, latlng.lat);
  });
  map.on("mouseout", () => { box.hidden = true; });
}

// CSS filter that maps the darkest and brightest values of the hillshade to 0 and 1.
function lightFilter({low, high}) {
  const gain = 1 / (high - low), contrast = 1 + 2 * gain * low;
  return `brightness(${gain / contrast}) contrast(${contrast})`;
}

// Shows one layer over the hillshade; the hillshade on top is multiplied into the colours by the layer's
// relief.
function chooseLayer(map, data, box) {
  const select = document.getElementById("layer"), opacity = document.getElementById("opacity");
  const wide = map.getSize().x >= 600, below = !wide && !data.routes.length;  // without profiles there is room below the map
  const legend = below ? L.DomUtil.create("div", "legend", document.getElementById("key")) : cornerBox(map, "bottomright", "legend");
  const folded = legend.appendChild(document.createElement("details"));
  folded.open = wide || below;
  folded.appendChild(document.createElement("summary")).textContent = "legend";
  folded.appendChild(document.createElement("div")).id = "legend";
  const names = [...data.layers.map(layer => layer.name), "hillshade only"];
  names.forEach((name, i) => select.add(new Option(name, i)));
  let colours, light;
  const show = () => {
    for (const shown of [colours, light]) if (shown) shown.remove();
    const layer = data.layers[select.value];
    colours = light = null;
    showLegend("layer", layer);
    if (!layer) return;
    colours = L.imageOverlay(layer.image, box, {alt: layer.name, zIndex: 2, opacity: opacity.value / 100}).addTo(map);
    light = L.imageOverlay(data.shade, box, {alt: "", zIndex: 3, opacity: layer.relief, className: "light"}).addTo(map);
    light.getElement().style.filter = lightFilter(data.light);
  };
  select.addEventListener("change", show);
  opacity.addEventListener("input", () => { if (colours) colours.setOpacity(opacity.value / 100); });
  show();
}

// Legend of the layer or route: colours with names, or a colour bar with its range and unit.
function showLegend(part, shown) {
  const legend = document.getElementById("legend");
  let entry = legend.querySelector(`[data-part=${part}]`);
  if (!entry) {
    entry = legend.appendChild(document.createElement("div"));
    entry.dataset.part = part;
  }
  entry.replaceChildren();
  if (!shown) return;
  const unit = shown.bar && shown.bar.unit ? ` [${shown.bar.unit}]` : "";
  entry.appendChild(document.createElement("strong")).textContent = shown.name + unit;
  for (const {colour, label} of shown.legend || []) {
    const item = entry.appendChild(document.createElement("span"));
    item.appendChild(document.createElement("i")).style.background = colour;
    item.append(label);
  }
  if (!shown.bar) return;
  const {colours, low, high} = shown.bar;
  entry.appendChild(document.createElement("b")).style.background = `linear-gradient(to right, ${colours.join()})`;
  const ends = entry.appendChild(document.createElement("span"));
  ends.className = "ends";
  for (const value of [low, (low + high) / 2, high])
    ends.appendChild(document.createElement("span")).textContent = Number(value.toPrecision(3)).toString();
}

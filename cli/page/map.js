// The map in metres (CRS.Simple): hillshade, one coloured layer, the route.
function drawMap(element, data) {
  const b = data.bounds, at = p => [p.y, p.x];
  const box = [[b.south, b.west], [b.north, b.east]];
  const map = L.map(element, {crs: L.CRS.Simple, minZoom: -20, maxZoom: 8, zoomSnap: 0.25, attributionControl: false});
  L.control.scale({imperial: false}).addTo(map);
  L.imageOverlay(data.shade, box, {alt: "hillshade"}).addTo(map);
  const layers = {};
  for (const layer of data.layers) {
    layers[layer.name] = L.imageOverlay(layer.image, box, {opacity: 0.6, alt: layer.name});
    layers[layer.name].legend = layer.legend;
  }
  layers["hillshade only"] = L.layerGroup();
  const first = Object.keys(layers)[0];
  layers[first].addTo(map);
  showLegend(first, layers[first].legend);
  map.on("baselayerchange", event => showLegend(event.name, event.layer.legend));
  const narrow = element.clientWidth < 600;
  L.control.layers(layers, {}, {collapsed: narrow}).addTo(map);
  const way = data.story
    ? [...data.story.track.map(([, x, y]) => ({x, y})), ...data.story.events.flatMap(e => e.route.map(([x, y]) => ({x, y})))]
    : data.route;
  const view = way.length ? L.latLngBounds(way.map(at)).pad(0.15) : L.latLngBounds(box);
  map.fitBounds(view, {paddingBottomRight: [narrow ? 0 : 170, 0]});  // space for the list of layers
  return map;
}

function showLegend(name, entries) {
  const legend = document.getElementById("legend");
  legend.replaceChildren();
  if (!entries) return;
  const title = legend.appendChild(document.createElement("strong"));
  title.textContent = name;
  for (const {colour, label} of entries) {
    const item = legend.appendChild(document.createElement("span"));
    item.appendChild(document.createElement("i")).style.background = colour;
    item.append(label);
  }
}

// Draws the route and returns {mark(point)}; calls onHover(point) when the pointer moves.
function drawRoute(map, points, onHover) {
  const line = points.map(p => [p.y, p.x]);
  L.polyline(line, {color: "#fff", weight: 7, interactive: false}).addTo(map);
  L.polyline(line, {color: "#1b3fbf", weight: 3.5, interactive: false}).addTo(map);
  points.forEach((p, i) => {
    const reverse = {color: "#b3202c", weight: 3.5, interactive: false};
    if (p.reverse && i + 1 < line.length) L.polyline([line[i], line[i + 1]], reverse).addTo(map);
    if (p.turn || (i > 0 && !!p.reverse !== !!points[i - 1].reverse))
      L.circleMarker(line[i], {radius: 4, color: "#b3202c", fillColor: "#b3202c", fillOpacity: 1, interactive: false}).addTo(map);
  });
  const wide = L.polyline(line, {color: "#000", opacity: 0, weight: 34}).addTo(map);
  const dot = L.circleMarker(line[0], {radius: 8, color: "#fff", weight: 3, fillColor: "#b3202c", fillOpacity: 1,
                                       interactive: false, className: "here"});
  for (const [place, letter] of [[line[0], "S"], [line[line.length - 1], "G"]])
    L.marker(place, {interactive: false, icon: L.divIcon({className: "end", html: `<span>${letter}</span>`, iconSize: [22, 22]})})
      .addTo(map);
  const nearest = spot => points.reduce((best, p) => {
    const d = (p.x - spot.lng) ** 2 + (p.y - spot.lat) ** 2;
    return d < best.d ? {d, p} : best;
  }, {d: Infinity}).p;
  wide.on("mousemove click", event => onHover(nearest(event.latlng)));
  return {mark(p) { dot.setLatLng([p.y, p.x]).addTo(map); }};
}

// Routes coloured by a quantity; the value at a vertex applies until the next vertex.
const perMetre = (points, i, key) => i + 1 < points.length && points[i + 1].s > points[i].s
  ? (points[i + 1][key] - points[i][key]) / (points[i + 1].s - points[i].s) : null;
const quantities = [
  {name: "slip", unit: "-", value: (points, i) => points[i].slip},
  {name: "slope along", unit: "deg", signed: true, value: (points, i) => points[i].slope},
  {name: "energy", unit: "J/m", value: (points, i) => {
    const kJ = perMetre(points, i, "energy");
    return kJ === null ? null : 1000 * kJ;
  }},
  {name: "immobilisation risk", unit: "1/km", value: (points, i) => {
    const risk = perMetre(points, i, "risk");
    return risk === null || points[i].risk >= 1 ? null : 1000 * risk / (1 - points[i].risk);
  }},
  {name: "category", value: (points, i) => points[i].category},
];

// Colours of all vertices of each route on one common scale, and the legend.
function coloursOf(quantity, data) {
  const values = data.routes.map(({points}) => points.map((_, i) => quantity.value(points, i)));
  if (!quantity.unit) {
    const colours = Object.fromEntries(data.categories.map(({colour, label}) => [label, colour]));
    return {colours: values.map(line => line.map(value => colours[value])),
            legend: {name: "route: " + quantity.name, legend: data.categories}};
  }
  let low = Infinity, high = -Infinity;
  for (const value of values.flat())
    if (value !== null) { low = Math.min(low, value); high = Math.max(high, value); }
  if (!(low <= high)) low = high = 0;
  if (quantity.signed) { high = Math.max(Math.abs(low), Math.abs(high)); low = -high; }
  if (!(high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high)))) high = low + 1;  // equal up to rounding
  const scale = quantity.signed ? data.scales.signed : data.scales.magnitude;
  const step = value => Math.min(scale.length - 1, Math.floor((value - low) / (high - low) * scale.length));
  const colours = values.map(line => line.map(value => value === null ? "#888" : scale[step(value)]));
  return {colours, legend: {name: "route: " + quantity.name, bar: {colours: scale, low, high, unit: quantity.unit}}};
}

// Draws the routes and returns {mark(points)}; calls onHover(route, point) when the pointer moves over a
// route.
function drawRoutes(map, data, onHover) {
  const routes = data.routes, lines = routes.map(({points}) => points.map(p => [p.y, p.x]));
  const select = document.getElementById("quantity");
  document.getElementById("by").hidden = false;
  quantities.forEach(({name}, i) => select.add(new Option(name, i)));
  const rim = {weight: 11, interactive: false, className: "rim"};
  const white = {color: "#fff", weight: 8, interactive: false};
  routes.forEach(({colour}, k) => {
    L.polyline(lines[k], {...rim, color: colour}).addTo(map);
    L.polyline(lines[k], white).addTo(map);
  });
  if (routes.length > 1)
    showLegend("routes", {name: "rim of each route", legend: routes.map(({colour, name}) => ({colour, label: name}))});
  const pieces = L.layerGroup().addTo(map);
  const paint = () => {
    const {colours, legend} = coloursOf(quantities[select.value], data);
    pieces.clearLayers();
    lines.forEach((line, k) => {
      paintLine(line, colours[k], pieces);
      manoeuvres(routes[k].points, line, pieces);
    });
    showLegend("route", legend);
  };
  select.addEventListener("change", paint);
  paint();
  const dots = routes.map(({colour}) => L.circleMarker([0, 0], {radius: 8, color: "#fff", weight: 3, fillColor: colour,
                                                                fillOpacity: 1, interactive: false, className: "here"}));
  lines.forEach((line, k) => {
    const wide = L.polyline(line, {color: "#000", opacity: 0, weight: 34}).addTo(map);
    wide.on("mousemove click", event => onHover(k, nearest(routes[k].points, event.latlng)));
    showEnd(map, line[0], "S");
    showEnd(map, line[line.length - 1], "G");
  });
  return {mark(points) {
    points.forEach((p, k) => { if (p) dots[k].setLatLng([p.y, p.x]).addTo(map); else dots[k].remove(); });
  }};
}

function nearest(points, spot) {
  return points.reduce((best, p) => {
    const d = (p.x - spot.lng) ** 2 + (p.y - spot.lat) ** 2;
    return d < best.d ? {d, p} : best;
  }, {d: Infinity}).p;
}

// Draws a line; all pieces of one colour form one path, because browsers draw few paths faster.
function paintLine(line, colours, group) {
  const pieces = new Map();
  for (let from = 0; from + 1 < line.length;) {
    let to = from + 1;
    while (to + 1 < line.length && colours[to] === colours[from]) ++to;
    if (!pieces.has(colours[from])) pieces.set(colours[from], []);
    pieces.get(colours[from]).push(line.slice(from, to + 1));
    from = to;
  }
  for (const [color, parts] of pieces)
    L.polyline(parts, {color, weight: 5, lineCap: "butt", interactive: false, className: "piece"}).addTo(group);
}

// Draws reverse sections dashed, and dots where the direction changes or the rover turns in place.
function manoeuvres(points, line, group) {
  const turn = {radius: 4, color: "#fff", weight: 1, fillColor: "#000", fillOpacity: 1, interactive: false};
  points.forEach((p, i) => {
    const reverse = {color: "#000", weight: 3, dashArray: "2 5", interactive: false};
    if (p.reverse && i + 1 < line.length) L.polyline([line[i], line[i + 1]], reverse).addTo(group);
    if (p.turn || (i > 0 && !!p.reverse !== !!points[i - 1].reverse))
      L.circleMarker(line[i], turn).addTo(group);
  });
}

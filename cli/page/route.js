// The route in the colours of a quantity; each has a value at every vertex that holds to the next one.
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

// The colour of each vertex and the legend of them all.
function coloursOf(quantity, points, data) {
  const values = points.map((_, i) => quantity.value(points, i));
  if (!quantity.unit) {
    const colours = Object.fromEntries(data.categories.map(({colour, label}) => [label, colour]));
    return {colours: values.map(value => colours[value]),
            legend: {name: "route: " + quantity.name, legend: data.categories}};
  }
  const known = values.filter(value => value !== null);
  let low = Math.min(...known), high = Math.max(...known);
  if (!known.length) low = high = 0;
  if (quantity.signed) { high = Math.max(Math.abs(low), Math.abs(high)); low = -high; }
  if (!(high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high)))) high = low + 1;  // all the same but for rounding
  const scale = quantity.signed ? data.scales.signed : data.scales.magnitude;
  const colours = values.map(value => value === null ? "#888"
    : scale[Math.min(scale.length - 1, Math.floor((value - low) / (high - low) * scale.length))]);
  return {colours, legend: {name: "route: " + quantity.name, bar: {colours: scale, low, high, unit: quantity.unit}}};
}

// Draws the route and returns {mark(point)}; calls onHover(point) when the pointer moves.
function drawRoute(map, data, onHover) {
  const points = data.route, line = points.map(p => [p.y, p.x]);
  const select = document.getElementById("quantity");
  document.getElementById("by").hidden = false;
  quantities.forEach(({name}, i) => select.add(new Option(name, i)));
  L.polyline(line, {color: "#1b3fbf", weight: 11, interactive: false}).addTo(map);
  L.polyline(line, {color: "#fff", weight: 8, interactive: false}).addTo(map);
  const pieces = L.layerGroup().addTo(map);
  const paint = () => {
    const {colours, legend} = coloursOf(quantities[select.value], points, data);
    pieces.clearLayers();
    for (let from = 0; from + 1 < line.length;) {
      let to = from + 1;
      while (to + 1 < line.length && colours[to] === colours[from]) ++to;
      const style = {color: colours[from], weight: 5, lineCap: "butt", interactive: false, className: "piece"};
      L.polyline(line.slice(from, to + 1), style).addTo(pieces);
      from = to;
    }
    manoeuvres(points, line, pieces);
    showLegend("route", legend);
  };
  select.addEventListener("change", paint);
  paint();
  const wide = L.polyline(line, {color: "#000", opacity: 0, weight: 34}).addTo(map);
  const dot = L.circleMarker(line[0], {radius: 8, color: "#fff", weight: 3, fillColor: "#1b3fbf", fillOpacity: 1,
                                       interactive: false, className: "here"});
  showEnd(map, line[0], "S");
  showEnd(map, line[line.length - 1], "G");
  const nearest = spot => points.reduce((best, p) => {
    const d = (p.x - spot.lng) ** 2 + (p.y - spot.lat) ** 2;
    return d < best.d ? {d, p} : best;
  }, {d: Infinity}).p;
  wide.on("mousemove click", event => onHover(nearest(event.latlng)));
  return {mark(p) { dot.setLatLng([p.y, p.x]).addTo(map); }};
}

// Where the rover drives backwards, dashed; dots where it changes direction or turns in place.
function manoeuvres(points, line, group) {
  const turn = {radius: 4, color: "#fff", weight: 1, fillColor: "#000", fillOpacity: 1, interactive: false};
  points.forEach((p, i) => {
    const reverse = {color: "#000", weight: 3, dashArray: "2 5", interactive: false};
    if (p.reverse && i + 1 < line.length) L.polyline([line[i], line[i + 1]], reverse).addTo(group);
    if (p.turn || (i > 0 && !!p.reverse !== !!points[i - 1].reverse))
      L.circleMarker(line[i], turn).addTo(group);
  });
}

// A ruler: clicks on the map add its points; lengths are distances in the map plane [m].
function offerRuler(map, data) {
  const button = document.getElementById("ruler"), steps = L.layerGroup().addTo(map);
  let places = [];
  const draw = () => {
    steps.clearLayers();
    for (const style of [{color: "#fff", weight: 6}, {color: "#000", weight: 2.5, className: "ruler"}])
      L.polyline(places, {interactive: false, ...style}).addTo(steps);
    for (const place of places)
      L.circleMarker(place, {radius: 4, color: "#000", weight: 2, fillColor: "#fff", fillOpacity: 1, interactive: false}).addTo(steps);
    if (places.length < 2) return;
    const length = places.slice(1).reduce((sum, place, i) => sum + map.distance(places[i], place), 0);
    const [from, to] = places.slice(-2), turn = 180 / Math.PI * Math.atan2(to.lng - from.lng, to.lat - from.lat);
    L.marker(to, {interactive: false, icon: L.divIcon({className: "", iconSize: [0, 0]})}).addTo(steps)
      .bindTooltip(`${length.toFixed(1)} m, last leg ${((turn + 360) % 360).toFixed(0)}° from north`, {permanent: true, direction: "right"});
  };
  const measuring = on => {
    button.setAttribute("aria-pressed", on);
    map.getContainer().classList.toggle("measuring", on);
    places = [];
    draw();
  };
  button.addEventListener("click", () => measuring(button.getAttribute("aria-pressed") === "false"));
  map.getContainer().addEventListener("keydown", ({key}) => { if (key === "Escape") measuring(false); });
  return {click(place) {
    if (button.getAttribute("aria-pressed") === "false") return false;
    places.push(place);
    draw();
    return true;
  }};
}

// A simulated traverse: the slider selects a time, at first the last one; the map shows the track, the planned route and the reclassified
// cells at that time, and rings around the soft patches that the planner does not know.
function showStory(map, story) {
  const at = ([x, y]) => [y, x];
  const track = story.track.map(([time, x, y, slip, energy, sinkage]) => ({time, x, y, slip, energy, sinkage}));
  const moment = document.getElementById("moment"), status = document.getElementById("status");
  const play = document.getElementById("play");
  document.getElementById("story").hidden = false;
  const dashes = colour => `repeating-linear-gradient(90deg, ${colour} 0 6px, #fff 6px 9px)`;
  showLegend("track", {name: "traverse", legend: [
    {colour: "#222", label: "driven"}, {colour: dashes("#1b3fbf"), label: "planned"},
    {colour: dashes("#7a1fa2"), label: "soft patch, unknown to the planner"}]});
  moment.max = track.length - 1;

  const cells = L.layerGroup().addTo(map);
  const canvas = L.canvas({padding: 0.5});
  for (const [x, y, radius] of story.patches)
    for (const style of [{color: "#fff", weight: 5}, {color: "#7a1fa2", weight: 2, dashArray: "5 4"}])
      L.circle([y, x], {radius, fill: false, interactive: false, ...style}).addTo(map);
  const rim = L.polyline([], {color: "#fff", weight: 6, interactive: false}).addTo(map);
  const planned = L.polyline([], {color: "#1b3fbf", weight: 3, dashArray: "7 6", interactive: false}).addTo(map);
  const halo = L.polyline([], {color: "#fff", weight: 7, interactive: false}).addTo(map);
  const driven = L.polyline([], {color: "#222", weight: 3.5, interactive: false}).addTo(map);
  const rover = L.circleMarker([track[0].y, track[0].x], {radius: 8, color: "#fff", weight: 3, fillColor: "#b3202c",
                                                          fillOpacity: 1, interactive: false, className: "here"}).addTo(map);

  // Adds reclassified cells as time increases, and removes them as time decreases.
  const drawn = [];
  function showCells(time) {
    while (drawn.length && story.changes[drawn.length - 1][0] > time) cells.removeLayer(drawn.pop());
    while (drawn.length < story.changes.length && story.changes[drawn.length][0] <= time) {
      const [, x, y, colour] = story.changes[drawn.length], h = story.cell / 2;
      drawn.push(L.rectangle([[y - h, x - h], [y + h, x + h]], {renderer: canvas, stroke: false, fillColor: colour,
                                                               fillOpacity: 1, interactive: false}).addTo(cells));
    }
  }

  function show(index) {
    const now = track[index];
    const past = story.events.filter(event => event.time <= now.time);
    const plan = past.filter(event => event.route.length).pop();
    const line = track.slice(0, index + 1).map(p => [p.y, p.x]);
    for (const shown of [rim, planned]) shown.setLatLngs(plan ? plan.route.map(at) : []);
    halo.setLatLngs(line);
    driven.setLatLngs(line);
    rover.setLatLng([now.y, now.x]);
    showCells(now.time);
    const latest = past.slice(-4).map(event => `${event.time.toFixed(0)} s ${event.text}`).join(" · ");
    status.textContent = `${now.time.toFixed(0)} s · slip ${now.slip.toFixed(2)} · sinkage ${(1000 * now.sinkage).toFixed(0)} mm · ` +
      `${now.energy.toFixed(2)} kJ · ${drawn.length} changes of category\n${latest}`;
  }

  let timer = 0;
  const stop = () => { clearInterval(timer); timer = 0; play.textContent = "play"; };
  play.addEventListener("click", () => {
    if (timer) return stop();
    if (+moment.value >= +moment.max) moment.value = 0;
    play.textContent = "pause";
    const stride = Math.max(1, Math.round(track.length / 400));
    timer = setInterval(() => {
      moment.value = +moment.value + stride;
      show(+moment.value);
      if (+moment.value >= +moment.max) stop();
    }, 40);
  });
  moment.addEventListener("input", () => { stop(); show(+moment.value); });
  const step = /^#(\d+)$/.exec(location.hash);  // page.html#120 opens at the 120th step
  moment.value = step ? Math.min(+step[1], track.length - 1) : track.length - 1;
  show(+moment.value);
  return {show(time) {
    stop();
    moment.value = track.findIndex(point => point.time >= time);
    show(+moment.value);
  }};
}

// Vega's CommonJS modules all define one global variable; each module is stored under its own name instead.
const vegaModules = {};
function vegaModule(name, body) {
  const module = {exports: {}};
  body(module.exports, needed => vegaModules[needed.replace("selections", "selection")], module);
  vegaModules[name] = module.exports;
}

// Draws a Vega specification in an element and returns its view.
function drawVega(spec, element, renderer) {
  const need = name => vegaModules["vega-" + name];
  for (const kind of ["transforms", "view-transforms", "encode"]) Object.assign(need("dataflow").transforms, need(kind));
  const view = new (need("view").View)(need("parser").parse(spec), {renderer, container: element, hover: false});
  view.run();
  return view;
}

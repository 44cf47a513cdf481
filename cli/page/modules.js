// Vega comes as CommonJS modules that all claim the same global; each is kept under its own name instead.
const vegaModules = {};
function vegaModule(name, body) {
  const module = {exports: {}};
  body(module.exports, needed => vegaModules[needed.replace("selections", "selection")], module);
  vegaModules[name] = module.exports;
}

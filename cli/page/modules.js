// Vega's CommonJS modules all define one global variable; each module is stored under its own name instead.
const vegaModules = {};
function vegaModule(name, body) {
  const module = {exports: {}};
  body(module.exports, needed => vegaModules[needed.replace("selections", "selection")], module);
  vegaModules[name] = module.exports;
}

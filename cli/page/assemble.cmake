# cmake -DOUTPUT=FILE -DPAGE=DIR -DLEAFLET=DIR -DVEGA=DIR [-DTHREE=DIR] -P assemble.cmake
# Joins the parts of the page template and the libraries. Without THREE the page has no 3-D relief view.
function(put text)
  file(APPEND "${OUTPUT}" "${text}")
endfunction()

# Links to source maps and to Leaflet's images are removed, because the page must not access the network.
function(put_script path)
  file(READ "${path}" text)
  string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" text "${text}")
  put("${text}\n")
endfunction()

function(put_style path)
  file(READ "${path}" text)
  string(REGEX REPLACE "/[*]# sourceMappingURL=[^\n]*" "" text "${text}")
  string(REGEX REPLACE "url\\([^)]*\\)" "none" text "${text}")
  put("${text}\n")
endfunction()

set(vega_modules util time format loader dataflow canvas scale scenegraph statistics expression selection functions
    runtime event-selector parser view transforms view-transforms encode)

file(WRITE "${OUTPUT}" "")
put_script("${PAGE}/head.html")
put("<style>\n")
put_style("${LEAFLET}/leaflet.css")
put_style("${PAGE}/page.css")
put("</style>\n")
put_script("${PAGE}/body.html")
# Stored as plain text; relief.js executes the text only when the relief view is opened.
if(THREE)
  put("<script type=\"text/plain\" id=\"three\">\n")
  put_script("${THREE}/three.min.js")
  put_script("${THREE}/examples/js/controls/OrbitControls.js")
  put("</script>\n")
endif()
put("<script>\n")
put_script("${LEAFLET}/leaflet.min.js")
put_script("${PAGE}/modules.js")
foreach(name IN LISTS vega_modules)
  put("vegaModule(\"vega-${name}\", function (exports, require, module) {\n")
  put_script("${VEGA}/vega-${name}.min.js")
  put("});\n")
endforeach()
foreach(name map route rose ruler probe profiles relief story page)
  put_script("${PAGE}/${name}.js")
endforeach()
put("</script>\n</body>\n</html>\n")

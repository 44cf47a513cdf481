# The page template: Talus' parts, Leaflet, Vega and, if installed, three.js in one file embedded in the
# program.
find_path(LEAFLET_DIR leaflet.min.js PATHS /usr/share/javascript/leaflet REQUIRED)
find_path(VEGA_DIR vega-view.min.js PATHS /usr/share/javascript/vega REQUIRED)
find_path(THREE_DIR examples/js/controls/OrbitControls.js PATHS /usr/share/javascript/three)
set(page_three "")
if(THREE_DIR)
  set(page_three -DTHREE=${THREE_DIR})
endif()
set(page_dir ${CMAKE_CURRENT_LIST_DIR})
set(page_template ${CMAKE_CURRENT_BINARY_DIR}/page_template.html)
set(report_template ${CMAKE_CURRENT_BINARY_DIR}/report_template.html)
add_custom_command(OUTPUT ${page_template}
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${page_template} -DPAGE=${page_dir} -DLEAFLET=${LEAFLET_DIR} -DVEGA=${VEGA_DIR} ${page_three}
          -P ${page_dir}/assemble.cmake
  DEPENDS ${page_dir}/assemble.cmake ${page_dir}/body.html ${page_dir}/head.html ${page_dir}/map.js
          ${page_dir}/modules.js ${page_dir}/page.css ${page_dir}/page.js ${page_dir}/probe.js ${page_dir}/profiles.js ${page_dir}/profiles.json
          ${page_dir}/relief.js ${page_dir}/rose.js ${page_dir}/ruler.js ${page_dir}/route.js ${page_dir}/story.js
  VERBATIM)
add_custom_command(OUTPUT ${report_template}
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${report_template} -DPAGE=${page_dir} -DVEGA=${VEGA_DIR} -P ${page_dir}/assemble.cmake
  DEPENDS ${page_dir}/assemble.cmake ${page_dir}/head.html ${page_dir}/modules.js ${page_dir}/report.css
          ${page_dir}/report.js ${page_dir}/chart.json
  VERBATIM)
set_source_files_properties(draw/page.cpp PROPERTIES OBJECT_DEPENDS "${page_template};${report_template}")
set_property(SOURCE draw/page.cpp PROPERTY COMPILE_DEFINITIONS TALUS_PAGE_TEMPLATE="${page_template}"
                                                               TALUS_REPORT_TEMPLATE="${report_template}")

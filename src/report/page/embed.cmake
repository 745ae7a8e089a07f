# The report's page, style and scripts, and Debian's three.js, as strings in the report stage.
find_file(EDGESLAM_THREE_JS three.min.js
  PATHS /usr/share/javascript/three /usr/share/javascript/three/build /usr/share/nodejs/three/build NO_CMAKE_FIND_ROOT_PATH)
find_file(EDGESLAM_ORBIT_CONTROLS_JS OrbitControls.js
  PATHS /usr/share/javascript/three/examples/js/controls NO_CMAKE_FIND_ROOT_PATH)
if(NOT EDGESLAM_THREE_JS OR NOT EDGESLAM_ORBIT_CONTROLS_JS)
  message(FATAL_ERROR "three.js, which the report's 3D map needs, was not found. "
    "Install it with 'apt-get install libjs-three', or set EDGESLAM_THREE_JS and EDGESLAM_ORBIT_CONTROLS_JS.")
endif()

function(edgeslam_read_asset variable path)
  file(READ ${path} content)
  set(${variable} "${content}" PARENT_SCOPE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
endfunction()

set(report_folder ${CMAKE_CURRENT_LIST_DIR})
edgeslam_read_asset(REPORT_PAGE ${report_folder}/page.html)
edgeslam_read_asset(REPORT_STYLE ${report_folder}/style.css)
edgeslam_read_asset(REPORT_CHARTS ${report_folder}/charts.js)
edgeslam_read_asset(REPORT_TRAJECTORY ${report_folder}/trajectory.js)
edgeslam_read_asset(REPORT_MAP ${report_folder}/map.js)
edgeslam_read_asset(REPORT_SCRIPT ${report_folder}/report.js)
edgeslam_read_asset(REPORT_THREE ${EDGESLAM_THREE_JS})
edgeslam_read_asset(REPORT_ORBIT_CONTROLS ${EDGESLAM_ORBIT_CONTROLS_JS})
configure_file(${report_folder}/report_assets.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/report_assets.cpp @ONLY)
target_sources(edgeslam_report PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/report_assets.cpp)

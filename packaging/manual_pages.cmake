# A manual page for the command and for each subcommand, from what --help says and packaging/man. Made by the target
# manual_pages, which packages need; help2man runs the program, in a cross build by its emulator. A page's name has no
# space.
find_program(HELP2MAN help2man)
if(NOT HELP2MAN)
  message(STATUS "Left out: manual pages (Debian package help2man)")
  return()
endif()

set(manual_folder ${CMAKE_BINARY_DIR}/man)
string(REPLACE ";" " " emulator "${CMAKE_CROSSCOMPILING_EMULATOR}")

# edgeslam_manual_page(NAME "ONE LINE" [SUBCOMMAND])
function(edgeslam_manual_page name line)
  set(page ${manual_folder}/${name}.1)
  set(sections ${CMAKE_SOURCE_DIR}/packaging/man/sections)
  string(STRIP "${emulator} $<TARGET_FILE:edgeslam> ${ARGN}" command)
  add_custom_command(OUTPUT ${page}.gz
    COMMAND ${CMAKE_COMMAND} -E make_directory ${manual_folder}
    COMMAND ${HELP2MAN} --no-info --section=1 --version-string=${PROJECT_VERSION} --source "Edge SLAM ${PROJECT_VERSION}"
      --name "${line}" --include ${sections} --output ${page} ${command}
    COMMAND sed -i -e "2s/EDGESLAM \\([A-Z-]*\\) /EDGESLAM-\\1 /" -e "4s/^edgeslam \\([a-z-]* \\\\-\\)/edgeslam-\\1/" ${page}
    COMMAND ${GZIP} -9nf ${page}
    DEPENDS edgeslam ${sections} VERBATIM)
  set(manual_pages ${manual_pages} ${page}.gz PARENT_SCOPE)
endfunction()

edgeslam_manual_page(edgeslam "monocular SLAM on image edges")
edgeslam_manual_page(edgeslam-run "poses from the camera to LCM" run)
edgeslam_manual_page(edgeslam-replay "run over recorded frames" replay)
edgeslam_manual_page(edgeslam-view "show a run over recorded frames in the browser" view)
edgeslam_manual_page(edgeslam-evaluate "error of a trajectory against a reference" evaluate)
edgeslam_manual_page(edgeslam-report "two runs side by side, or a table of runs" report)
edgeslam_manual_page(edgeslam-benchmark "run over all sequences under a folder" benchmark)
edgeslam_manual_page(edgeslam-simulate "make a sequence with exact ground truth" simulate)
edgeslam_manual_page(edgeslam-listen "show what is published over LCM" listen)
edgeslam_manual_page(edgeslam-calibrate "calibrate a camera with a printed board" calibrate)
edgeslam_manual_page(edgeslam-map "what is in saved maps; several made into one; parts taken out" map)
edgeslam_manual_page(edgeslam-mask "propose where the camera's images are not looked at" mask)
edgeslam_manual_page(edgeslam-check-config "check a configuration or calibration" check-config)
edgeslam_manual_page(edgeslam-cameras "list the cameras" cameras)
edgeslam_manual_page(edgeslam-record "record a camera's frames" record)
add_custom_target(manual_pages DEPENDS ${manual_pages})
install(FILES ${manual_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT edgeslam OPTIONAL)

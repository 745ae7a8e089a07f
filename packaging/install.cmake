# Where things go on a robot, by package: the program (edgeslam), what only videos and boards with markers need
# (edgeslam-tools), the library (libedgeslam2), what programs are built with (libedgeslam-dev), and what ROS 2 needs
# (edgeslam-ros2). The places are systemd's and Debian's; the service expects /usr/bin. Its user is made by sysusers.d.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS edgeslam RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT edgeslam)
install(FILES systemd/edgeslam.service DESTINATION lib/systemd/system COMPONENT edgeslam)
install(FILES systemd/70-edgeslam-camera.rules DESTINATION lib/udev/rules.d COMPONENT edgeslam)
install(FILES systemd/sysusers.conf DESTINATION lib/sysusers.d RENAME edgeslam.conf COMPONENT edgeslam)
install(FILES packaging/robot.yaml DESTINATION /etc/edgeslam COMPONENT edgeslam)
install(DIRECTORY firmware_cfg/ DESTINATION ${CMAKE_INSTALL_DATADIR}/edgeslam COMPONENT edgeslam)
install(DIRECTORY drivers/lcm/types/ DESTINATION ${CMAKE_INSTALL_DATADIR}/edgeslam/lcm COMPONENT edgeslam)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/edgeslam COMPONENT edgeslam)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/edgeslam COMPONENT edgeslam)
install(FILES packaging/edgeslam.bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME edgeslam COMPONENT edgeslam)
install(TARGETS edgeslam_video edgeslam_markers LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/edgeslam COMPONENT edgeslam-tools)
if(EDGESLAM_HAS_ROS2)
  install(TARGETS edgeslam_ros2_dds LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/edgeslam COMPONENT edgeslam-ros2)
  set(ros2_package edgeslam-ros2)
endif()

install(TARGETS edgeslam_shared EXPORT edgeslam
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libedgeslam2 NAMELINK_COMPONENT libedgeslam-dev)
install(DIRECTORY include/edgeslam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT libedgeslam-dev)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libedgeslam-dev COMPONENT libedgeslam-dev)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/edgeslam)
install(EXPORT edgeslam NAMESPACE edgeslam:: FILE edgeslam-config.cmake DESTINATION ${package_folder}
  COMPONENT libedgeslam-dev)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/edgeslam-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/edgeslam-config-version.cmake DESTINATION ${package_folder} COMPONENT libedgeslam-dev)

# Each package has its licence and its list of changes; Debian wants the latter packed.
find_program(GZIP gzip REQUIRED)
set(changes ${CMAKE_BINARY_DIR}/changelog.gz)
execute_process(COMMAND ${GZIP} -9nc ${CMAKE_SOURCE_DIR}/packaging/debian/changelog OUTPUT_FILE ${changes}
  COMMAND_ERROR_IS_FATAL ANY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS packaging/debian/changelog)
foreach(package edgeslam edgeslam-tools libedgeslam2 libedgeslam-dev ${ros2_package})
  install(FILES packaging/debian/copyright ${changes} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
    COMPONENT ${package})
endforeach()

include(packaging/manual_pages.cmake)

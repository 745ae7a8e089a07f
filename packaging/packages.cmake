# Debian packages:  cmake --preset packages && cmake --build --preset packages && (cd build/packages && cpack)
option(EDGESLAM_DEBUG_SYMBOLS "Packages of debug symbols (functions and lines), too; objects take 30 times the space" OFF)
if(EDGESLAM_DEBUG_SYMBOLS)
  target_compile_options(edgeslam_settings INTERFACE -g1 -fdebug-prefix-map=${CMAKE_SOURCE_DIR}=/usr/src/edgeslam)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME edgeslam)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Edge SLAM maintainers <maintainers@users.noreply.h-seed-3b6aca39.example>")
set(CPACK_PACKAGE_VENDOR "Edge SLAM")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
if(EDGESLAM_DEBUG_SYMBOLS)
  set(CPACK_DEBIAN_EDGESLAM_DEBUGINFO_PACKAGE ON)  # strips, too
  set(CPACK_DEBIAN_EDGESLAM-TOOLS_DEBUGINFO_PACKAGE ON)
  set(CPACK_DEBIAN_LIBEDGESLAM2_DEBUGINFO_PACKAGE ON)
  set(CPACK_DEBIAN_EDGESLAM-ROS2_DEBUGINFO_PACKAGE ON)
else()
  set(CPACK_STRIP_FILES ON)
endif()
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL edgeslam edgeslam-tools libedgeslam2 libedgeslam-dev ${ros2_package})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^arm")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE armhf)
endif()

if(CMAKE_CROSSCOMPILING)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS)
  foreach(folder lib usr/lib usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/blas usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/lapack)
    string(REGEX REPLACE "lib$" "lib/${CMAKE_LIBRARY_ARCHITECTURE}" folder ${folder})
    list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_SYSROOT}/${folder})
  endforeach()
  set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_BINARY_DIR}/cross_packages.cmake)
  configure_file(packaging/cross_packages.cmake.in ${CPACK_PROJECT_CONFIG_FILE} @ONLY)
endif()

set(CPACK_COMPONENT_EDGESLAM_DESCRIPTION "monocular SLAM on image edges, as a service over LCM
Edge SLAM tells a robot with one camera where it is, at every frame, also in
front of bare walls: it follows points on image edges, builds a 3D map of them,
and publishes a pose with its uncertainty over LCM.

This package has the command, the service and its configuration.")
set(CPACK_DEBIAN_EDGESLAM_PACKAGE_NAME edgeslam)
set(CPACK_DEBIAN_EDGESLAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_EDGESLAM_PACKAGE_RECOMMENDS "libcamera-ipa")
string(REPLACE ";" ", " suggested "edgeslam-tools;${ros2_package}")
set(CPACK_DEBIAN_EDGESLAM_PACKAGE_SUGGESTS ${suggested})
set(CPACK_DEBIAN_EDGESLAM_PACKAGE_DEPENDS "procps, systemd | systemd-standalone-sysusers")  # procps: kill, to reload
set(CPACK_DEBIAN_EDGESLAM_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packaging/debian/conffiles
  ${CMAKE_SOURCE_DIR}/packaging/debian/postinst ${CMAKE_SOURCE_DIR}/packaging/debian/prerm
  ${CMAKE_SOURCE_DIR}/packaging/debian/postrm)

set(CPACK_COMPONENT_EDGESLAM-TOOLS_DESCRIPTION "monocular SLAM on image edges, videos and boards with markers
Edge SLAM tells a robot with one camera where it is, at every frame, also in
front of bare walls: it follows points on image edges, builds a 3D map of them,
and gives a pose with its uncertainty.

This package lets the command read videos, and calibrate cameras with boards
that have markers (ChArUco, AprilGrid), for the desk rather than the robot.")
set(CPACK_DEBIAN_EDGESLAM-TOOLS_PACKAGE_NAME edgeslam-tools)
set(CPACK_DEBIAN_EDGESLAM-TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_EDGESLAM-TOOLS_PACKAGE_DEPENDS "edgeslam (= ${PROJECT_VERSION})")

set(CPACK_COMPONENT_EDGESLAM-ROS2_DESCRIPTION "monocular SLAM on image edges, messages to ROS 2
Edge SLAM tells a robot with one camera where it is, at every frame, also in
front of bare walls: it follows points on image edges, builds a 3D map of them,
and gives a pose with its uncertainty.

This package lets the service publish for ROS 2, which need not be installed,
by Cyclone DDS.")
set(CPACK_DEBIAN_EDGESLAM-ROS2_PACKAGE_NAME edgeslam-ros2)
set(CPACK_DEBIAN_EDGESLAM-ROS2_PACKAGE_SECTION science)
set(CPACK_DEBIAN_EDGESLAM-ROS2_PACKAGE_DEPENDS "edgeslam (= ${PROJECT_VERSION})")

set(CPACK_COMPONENT_LIBEDGESLAM2_DESCRIPTION "monocular SLAM on image edges, shared library
Edge SLAM tells a robot with one camera where it is, at every frame, also in
front of bare walls: it follows points on image edges, builds a 3D map of them,
and gives a pose with its uncertainty.

This package has the library that programs use.")
set(CPACK_DEBIAN_LIBEDGESLAM2_PACKAGE_NAME libedgeslam2)
set(CPACK_DEBIAN_LIBEDGESLAM2_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBEDGESLAM2_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packaging/debian/triggers)

set(CPACK_COMPONENT_LIBEDGESLAM-DEV_DESCRIPTION "monocular SLAM on image edges, development files
Edge SLAM tells a robot with one camera where it is, at every frame, also in
front of bare walls: it follows points on image edges, builds a 3D map of them,
and gives a pose with its uncertainty.

This package has the headers and the CMake package to build programs with.")
set(CPACK_DEBIAN_LIBEDGESLAM-DEV_PACKAGE_NAME libedgeslam-dev)
set(CPACK_DEBIAN_LIBEDGESLAM-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBEDGESLAM-DEV_PACKAGE_DEPENDS "libedgeslam2 (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_LIBEDGESLAM-DEV_PACKAGE_SHLIBDEPS OFF)

include(CPack)

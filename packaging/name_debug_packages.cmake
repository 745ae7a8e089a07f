# Run by CPack at the end: packages of debug symbols are called .deb, as Debian's are, so that apt installs them.
foreach(package IN LISTS CPACK_PACKAGE_FILES)
  if(package MATCHES "\\.ddeb$")
    string(REGEX REPLACE "\\.ddeb$" ".deb" renamed ${package})
    file(RENAME ${package} ${renamed})
  endif()
endforeach()

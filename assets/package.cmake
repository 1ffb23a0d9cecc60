# Debian packages, of the program and of the Python module: cmake --workflow --preset package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME topple)
set(CPACK_PACKAGE_CONTACT "The topple developers <topple@localhost.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "shows how furniture tips over when the floor shakes")
set(CPACK_PACKAGE_DESCRIPTION
  "A finite-element model of cabinets on a shaking floor, with large rotations
and frictional contact, that runs faster than real time, is recorded, and can
be watched in a window or drawn without a display.")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/solver)
# Loaded while it runs, so that no linker knows: OSMesa or EGL and the font for pictures, OpenGL for the window.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME topple)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libosmesa6 | libegl1, libosmesa6 | libegl-mesa0, fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libgl1, libegl1, libegl-mesa0, ffmpeg, gnuplot-nox, fonts-vlgothic")
if(TOPPLE_PYTHON)
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-topple)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "topple (= ${PROJECT_VERSION}), python3-numpy, \
python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_python})")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The Python module: scenes, runs and recordings as NumPy arrays, simulations
that are stepped, edited and forked, and pictures.")
endif()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)

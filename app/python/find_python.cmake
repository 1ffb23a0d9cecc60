# TOPPLE_PYTHON: whether the Python module is built: with Debian's Python, for which its pybind11 and NumPy are.
# In release builds alone, as Python cannot load a module with sanitizers.
set(TOPPLE_PYTHON OFF)
if(CMAKE_BUILD_TYPE STREQUAL Release)
  find_program(Python3_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
  find_package(Python3 QUIET COMPONENTS Interpreter Development.Module NumPy)
  find_package(pybind11 QUIET)
  if(Python3_FOUND AND pybind11_FOUND)
    set(TOPPLE_PYTHON ON)
    # It is linked from the same static libraries as the program.
    set(CMAKE_POSITION_INDEPENDENT_CODE ON)
    add_compile_options(-fno-semantic-interposition)
  else()
    message(STATUS "No Python module: it needs the packages pybind11-dev, python3-dev and python3-numpy")
  endif()
endif()

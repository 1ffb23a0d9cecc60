# What the Python module promises, by pytest, held against the program.
if(TOPPLE_PYTHON)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import pytest" RESULT_VARIABLE no_pytest OUTPUT_QUIET ERROR_QUIET)
  if(no_pytest)
    message(STATUS "No tests of the Python module: they need the package python3-pytest")
  else()
    foreach(subject guide picture result scene simulation types)
      add_test(NAME Python.${subject} COMMAND ${Python3_EXECUTABLE} -B -m pytest -q -p no:cacheprovider
        ${CMAKE_CURRENT_LIST_DIR}/${subject}_test.py)
      set_tests_properties(Python.${subject} PROPERTIES TIMEOUT 200
        ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;TOPPLE_PROGRAM=$<TARGET_FILE:topple>")
    endforeach()
  endif()
endif()

# What the Python module promises, by pytest, held against the program.
if(TOPPLE_PYTHON)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import pytest" RESULT_VARIABLE no_pytest OUTPUT_QUIET ERROR_QUIET)
  if(no_pytest)
    message(STATUS "No tests of the Python module: they need the package python3-pytest")
  else()
    set(subjects guide page picture result scene simulation sweep types)
    execute_process(COMMAND ${Python3_EXECUTABLE} -c "import nbconvert, ipykernel, matplotlib"
      RESULT_VARIABLE no_notebooks OUTPUT_QUIET ERROR_QUIET)
    if(no_notebooks)
      message(STATUS "No tests of the notebooks: they need python3-nbconvert, python3-ipykernel and python3-matplotlib")
    else()
      list(APPEND subjects notebooks)
    endif()
    foreach(subject ${subjects})
      add_test(NAME Python.${subject} COMMAND ${Python3_EXECUTABLE} -B -m pytest -q -p no:cacheprovider
        ${CMAKE_CURRENT_LIST_DIR}/${subject}_test.py)
      set_tests_properties(Python.${subject} PROPERTIES TIMEOUT 300
        ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;TOPPLE_PROGRAM=$<TARGET_FILE:topple>")
    endforeach()
  endif()
endif()

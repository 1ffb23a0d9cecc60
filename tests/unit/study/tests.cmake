find_package(ZLIB REQUIRED)
add_executable(study_test
  ${CMAKE_CURRENT_LIST_DIR}/anchors_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/axis_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/convergence_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/criteria_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/elements_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/factors_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fragility_study_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fragility_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/furniture_study_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/general_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/granite_fit_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/intensity_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/kept_rows_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/low_discrepancy_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/overturn_map_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/penalty_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/precision_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/refinement_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/spread_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/stability_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/standing_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/team_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/theory_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/toss_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/validate_test.cpp)
target_link_libraries(study_test PRIVATE topple_study ZLIB::ZLIB GTest::gtest_main)
target_include_directories(study_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/stability_test.cpp PROPERTIES
  COMPILE_DEFINITIONS TOPPLE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
gtest_discover_tests(study_test TEST_FILTER -Penalty*:ElementsStudy*:GraniteFit*)
foreach(study Penalty ElementsStudy GraniteFit)  # their tests share the runs of a study
  add_test(NAME ${study} COMMAND study_test --gtest_filter=${study}*)
endforeach()

add_executable(recording_test
  ${CMAKE_CURRENT_LIST_DIR}/recording_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_anchor_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_damage_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_formats_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_history_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_plastic_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_recover_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_rerun_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_run_test.cpp)
target_link_libraries(recording_test PRIVATE topple_io GTest::gtest_main)
target_compile_definitions(recording_test PRIVATE TOPPLE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(recording_test PROPERTIES UNITY_BUILD_BATCH_SIZE 24)
gtest_discover_tests(recording_test)

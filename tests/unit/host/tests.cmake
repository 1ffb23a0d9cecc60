add_executable(host_test
  ${CMAKE_CURRENT_LIST_DIR}/file_kind_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/process_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/staged_file_test.cpp)
target_link_libraries(host_test PRIVATE topple_host GTest::gtest_main)
gtest_discover_tests(host_test)

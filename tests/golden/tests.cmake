add_executable(render_golden_test ${CMAKE_CURRENT_LIST_DIR}/picture_golden_test.cpp)
target_link_libraries(render_golden_test PRIVATE topple_render PkgConfig::IMGUI GTest::gtest_main)
target_compile_definitions(render_golden_test PRIVATE
  TOPPLE_GOLDEN_DIR="${CMAKE_CURRENT_LIST_DIR}" TOPPLE_GOLDEN_OUT="${CMAKE_CURRENT_BINARY_DIR}/golden")
gtest_discover_tests(render_golden_test)

add_executable(window_golden_test ${CMAKE_CURRENT_LIST_DIR}/window_golden_test.cpp)
target_include_directories(window_golden_test PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests
  ${PROJECT_SOURCE_DIR}/tests/unit/app)
target_link_libraries(window_golden_test PRIVATE topple_app PkgConfig::IMGUI GTest::gtest_main)
target_compile_definitions(window_golden_test PRIVATE TOPPLE_PROGRAM="$<TARGET_FILE:topple>"
  TOPPLE_GOLDEN_DIR="${CMAKE_CURRENT_LIST_DIR}" TOPPLE_GOLDEN_OUT="${CMAKE_BINARY_DIR}/tests/golden")
add_dependencies(window_golden_test topple)
gtest_discover_tests(window_golden_test PROPERTIES TIMEOUT 1500)

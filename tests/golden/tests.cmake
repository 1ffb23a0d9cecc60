add_executable(render_golden_test ${CMAKE_CURRENT_LIST_DIR}/picture_golden_test.cpp)
target_link_libraries(render_golden_test PRIVATE topple_render PkgConfig::IMGUI GTest::gtest_main)
target_compile_definitions(render_golden_test PRIVATE
  TOPPLE_GOLDEN_DIR="${CMAKE_CURRENT_LIST_DIR}" TOPPLE_GOLDEN_OUT="${CMAKE_CURRENT_BINARY_DIR}/golden")
gtest_discover_tests(render_golden_test)

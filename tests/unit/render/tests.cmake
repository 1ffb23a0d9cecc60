pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
add_executable(render_test
  ${CMAKE_CURRENT_LIST_DIR}/camera_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/colour_map_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/image_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/mesh_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/overlay_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/video_test.cpp)
# imgui brings libstb: pictures are read back by a decoder that shares nothing with the writer.
target_link_libraries(render_test PRIVATE topple_render PkgConfig::IMGUI GTest::gtest_main)
add_executable(draw_one ${CMAKE_CURRENT_LIST_DIR}/draw_one.cpp)
target_link_libraries(draw_one PRIVATE topple_render)
target_compile_definitions(render_test PRIVATE TOPPLE_DRAW_ONE="$<TARGET_FILE:draw_one>")
add_dependencies(render_test draw_one)
gtest_discover_tests(render_test)

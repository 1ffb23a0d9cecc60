pkg_check_modules(GLFW REQUIRED IMPORTED_TARGET glfw3)
add_executable(render_test
  ${CMAKE_CURRENT_LIST_DIR}/camera_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/colour_map_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/image_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/mesh_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/no_display_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/orbit_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/overlay_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/pick_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/stage_test.cpp)
# imgui brings libstb: pictures are read back by a decoder that shares nothing with the writer.
target_link_libraries(render_test PRIVATE topple_render PkgConfig::IMGUI GTest::gtest_main)
add_executable(draw_one ${CMAKE_CURRENT_LIST_DIR}/draw_one.cpp)
target_link_libraries(draw_one PRIVATE topple_render PkgConfig::IMGUI)
target_compile_definitions(render_test PRIVATE TOPPLE_DRAW_ONE="$<TARGET_FILE:draw_one>")
add_dependencies(render_test draw_one)
set_target_properties(render_test PROPERTIES UNITY_BUILD OFF)
gtest_discover_tests(render_test)

# A process holds one kind of context: the window's tests compare with what another one drew.
add_executable(render_window_test ${CMAKE_CURRENT_LIST_DIR}/window_test.cpp)
target_link_libraries(render_window_test PRIVATE topple_render PkgConfig::IMGUI PkgConfig::GLFW GTest::gtest_main)
add_executable(draw_stage ${CMAKE_CURRENT_LIST_DIR}/draw_stage.cpp)
target_link_libraries(draw_stage PRIVATE topple_render PkgConfig::IMGUI)
target_compile_definitions(render_window_test PRIVATE TOPPLE_DRAW_STAGE="$<TARGET_FILE:draw_stage>")
add_dependencies(render_window_test draw_stage)
add_test(NAME render_window_test COMMAND xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" $<TARGET_FILE:render_window_test>)
set_tests_properties(render_window_test PROPERTIES TIMEOUT 120)

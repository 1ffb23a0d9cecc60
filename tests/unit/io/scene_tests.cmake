add_executable(scene_test
  ${CMAKE_CURRENT_LIST_DIR}/accelerogram_file_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/check_whole_scene_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/checked_in_scene_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/contents_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/edit_text_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/furniture_kind_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/feet_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fixing_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/hinge_scenes_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/furniture_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_block_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_choices_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_difference_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_errors_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_panel_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_robustness_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_record_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_room_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_save_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_static_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/stiff_frames_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/toml_precheck_test.cpp)
target_include_directories(scene_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
target_link_libraries(scene_test PRIVATE topple_io GTest::gtest_main)
target_compile_definitions(scene_test PRIVATE TOPPLE_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
  TOPPLE_MAKE_RECORDS="$<TARGET_FILE:make_records>")
add_dependencies(scene_test make_records)
gtest_discover_tests(scene_test)

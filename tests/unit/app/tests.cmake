add_library(failing_writes MODULE ${CMAKE_CURRENT_LIST_DIR}/cli/failing_writes.cpp)
target_link_libraries(failing_writes PRIVATE ${CMAKE_DL_LIBS})
add_library(failing_hdf5 MODULE ${CMAKE_CURRENT_LIST_DIR}/cli/failing_hdf5.cpp)
target_link_libraries(failing_hdf5 PRIVATE PkgConfig::HDF5)
add_executable(app_test
  ${CMAKE_CURRENT_LIST_DIR}/batch/summary_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/analysis_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/bad_output_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/bad_recording_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/bad_scene_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/compare_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/documents_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/export_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/failing_write_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/failures_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/full_disk_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/gltf_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/interrupt_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/manual_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/recording_formats_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/recover_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/render_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/run_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/usage_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/verification_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cli/verify_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/furnish/furnish_view_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/furnish/room_edits_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/furnish/snap_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gltf/key_frames_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/live/live_recorder_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/live/player_branches_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/live/player_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/page/block_map_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/page/page_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/panels/appearance_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/panels/computed_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/panels/criteria_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/panels/demo_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/panels/load_path_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/panels/lane_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/panels/subject_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/block_picture_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/bridge_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/drawing_processes_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/image_files_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/rigid_fit_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/thinning_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/touching_bodies_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/picture/words_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/report/report_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/study/fragility_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/study/overturn_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/study/precision_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/study/present_studies_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/study/stability_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/study/study_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/study/validate_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/support/files_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/support/foreign_recording_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/support/progress_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/window/export_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/window/seen_and_exported_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/window/shell_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/window/shortcuts_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/window/soak_test.cpp
  ${CMAKE_CURRENT_LIST_DIR}/window/viewer_test.cpp)
target_include_directories(app_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
target_link_libraries(app_test PRIVATE topple_app PkgConfig::IMGUI GTest::gtest_main)
target_compile_definitions(app_test PRIVATE TOPPLE_PROGRAM="$<TARGET_FILE:topple>"
  TOPPLE_FAILING_WRITES="$<TARGET_FILE:failing_writes>" TOPPLE_FAILING_HDF5="$<TARGET_FILE:failing_hdf5>"
  TOPPLE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_dependencies(app_test topple failing_writes failing_hdf5)
gtest_discover_tests(app_test PROPERTIES TIMEOUT 400)

# It listens to what is written: Dear ImGui's AddText.
add_executable(window_text_test ${CMAKE_CURRENT_LIST_DIR}/window/window_text_test.cpp)
target_include_directories(window_text_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
target_link_libraries(window_text_test PRIVATE topple_app PkgConfig::IMGUI GTest::gtest_main)
target_link_options(window_text_test PRIVATE
  -Wl,--wrap=_ZN10ImDrawList7AddTextEPK6ImFontfRK6ImVec2jPKcS7_fPK6ImVec4
  -Wl,--wrap=_ZN10ImDrawList7AddTextERK6ImVec2jPKcS4_)
gtest_discover_tests(window_text_test PROPERTIES TIMEOUT 120)

# Dear ImGui's assertions and items, and the frames that are drawn, pass through it.
add_executable(random_events_test ${CMAKE_CURRENT_LIST_DIR}/window/random_events_test.cpp)
target_include_directories(random_events_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
target_link_libraries(random_events_test PRIVATE topple_app PkgConfig::IMGUI GTest::gtest_main)
target_compile_definitions(random_events_test PRIVATE TOPPLE_PROGRAM="$<TARGET_FILE:topple>")
target_link_options(random_events_test PRIVATE
  -Wl,--wrap=__assert_fail
  -Wl,--wrap=_ZN5ImGui7ItemAddERK6ImRectjPS1_i
  -Wl,--wrap=_ZN6topple6render5Stage10draw_sceneERKNS0_10SceneFrameERKNS0_6CameraENS0_9ColourMapEiiNS0_7QualityE)
add_dependencies(random_events_test topple)
gtest_discover_tests(random_events_test PROPERTIES TIMEOUT 900)
foreach(drawn scene room throw pour)
  add_executable(random_${drawn}_test ${CMAKE_CURRENT_LIST_DIR}/cli/random_${drawn}_test.cpp)
  target_include_directories(random_${drawn}_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
  target_link_libraries(random_${drawn}_test PRIVATE topple_app GTest::gtest_main)
  gtest_discover_tests(random_${drawn}_test PROPERTIES TIMEOUT 600)
endforeach()

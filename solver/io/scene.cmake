include(${PROJECT_SOURCE_DIR}/assets/embed.cmake)

file(GLOB scene_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/assets/furniture/*.toml
  ${PROJECT_SOURCE_DIR}/assets/scenes/*.toml
  ${PROJECT_SOURCE_DIR}/assets/scenes/elements/*.toml
  ${PROJECT_SOURCE_DIR}/assets/scenes/verify/*.toml)
topple_embed(
  TEMPLATE ${PROJECT_SOURCE_DIR}/solver/io/builtin/builtin_scenes.cpp.in
  OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_scenes.cpp
  BASE ${PROJECT_SOURCE_DIR}/assets
  FILES ${scene_files})

set(record_files
  ${PROJECT_SOURCE_DIR}/assets/records/long-period-x.AT2
  ${PROJECT_SOURCE_DIR}/assets/records/long-period-y.EW
  ${PROJECT_SOURCE_DIR}/assets/records/near-fault.csv)
topple_embed(
  TEMPLATE ${PROJECT_SOURCE_DIR}/solver/io/builtin/builtin_records.cpp.in
  OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_records.cpp
  WITH_EXTENSION
  FILES ${record_files})

target_sources(topple_scene PRIVATE
  ${CMAKE_CURRENT_BINARY_DIR}/builtin_scenes.cpp
  ${CMAKE_CURRENT_BINARY_DIR}/builtin_records.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/accelerogram/accelerogram_csv.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/accelerogram/accelerogram_file.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/accelerogram/accelerogram_text.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/edit/scene_difference.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/edit/scene_number.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/edit/scene_rewrite.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/edit/scene_save.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/edit/edit_text.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/furniture.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/furniture_fit.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/furniture_kind.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/furniture_place.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_anchors.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_bodies.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_check.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/document/scene_document.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_entry.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/check/scene_errors.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_file.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_fittings.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_fixings.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_keys.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_keys_bodies.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_keys_fittings.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/document/scene_override.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_overlap.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_planar.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_read.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_reference.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/common/digits.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/common/nearest_name.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/document/toml_precheck.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_room.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/scene/scene_shakes.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/builtin/stock.cpp
  ${PROJECT_SOURCE_DIR}/solver/io/common/units.cpp)

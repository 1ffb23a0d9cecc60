# Recordings (HDF5) and their export.
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET GLOBAL hdf5-serial)
target_sources(topple_io PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/recording/frame_row.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/hdf5_handle.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/hdf5_read_driver.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/observer.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recorded_scene.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recorder.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recording_format.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recording_history.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recording_model.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recording_reader.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recording_writer.cpp
  ${CMAKE_CURRENT_LIST_DIR}/export/export_csv.cpp
  ${CMAKE_CURRENT_LIST_DIR}/export/export_vtk.cpp
  ${CMAKE_CURRENT_LIST_DIR}/export/export_xdmf.cpp
  ${CMAKE_CURRENT_LIST_DIR}/export/exported_values.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/recover.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording/rerun.cpp)
target_link_libraries(topple_io PUBLIC PkgConfig::HDF5)

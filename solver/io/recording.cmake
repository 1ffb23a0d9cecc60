# Recordings (HDF5) and their export.
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET GLOBAL hdf5-serial)
target_sources(topple_io PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/frame_row.cpp
  ${CMAKE_CURRENT_LIST_DIR}/hdf5_handle.cpp
  ${CMAKE_CURRENT_LIST_DIR}/hdf5_read_driver.cpp
  ${CMAKE_CURRENT_LIST_DIR}/observer.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recorder.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_format.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_history.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_model.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_reader.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recording_writer.cpp
  ${CMAKE_CURRENT_LIST_DIR}/export_csv.cpp
  ${CMAKE_CURRENT_LIST_DIR}/export_vtk.cpp
  ${CMAKE_CURRENT_LIST_DIR}/export_xdmf.cpp
  ${CMAKE_CURRENT_LIST_DIR}/exported_values.cpp
  ${CMAKE_CURRENT_LIST_DIR}/recover.cpp
  ${CMAKE_CURRENT_LIST_DIR}/common/staged_file.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rerun.cpp)
target_link_libraries(topple_io PUBLIC PkgConfig::HDF5)

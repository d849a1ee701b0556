# What `cmake --install` adds for programs of others: the libraries of tires and terrains with their headers, and the
# CMake package that `find_package(Furrow)` finds (package/FurrowConfig.cmake.in).
include(CMakePackageConfigHelpers)
set(_libraries furrow_interface furrow_core furrow_files furrow_tire furrow_terrain)
foreach(_library ${_libraries})
  string(REPLACE furrow_ "" _name ${_library})
  set_target_properties(${_library} PROPERTIES EXPORT_NAME ${_name})
endforeach()
install(TARGETS ${_libraries} EXPORT FurrowTargets COMPONENT libraries
        ARCHIVE DESTINATION lib/furrow INCLUDES DESTINATION include/furrow)
install(EXPORT FurrowTargets NAMESPACE Furrow:: DESTINATION lib/cmake/Furrow COMPONENT libraries)
foreach(_folder protocol/core protocol/files tire terrain)
  cmake_path(GET _folder PARENT_PATH _parent)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${_folder} DESTINATION include/furrow/${_parent} COMPONENT libraries
          FILES_MATCHING PATTERN "*.hpp" PATTERN data EXCLUDE PATTERN soil EXCLUDE)
endforeach()

set(FURROW_DATA_FOLDER share/furrow)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/package/FurrowConfig.cmake.in
  ${CMAKE_BINARY_DIR}/package/FurrowConfig.cmake INSTALL_DESTINATION lib/cmake/Furrow PATH_VARS FURROW_DATA_FOLDER)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/FurrowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/package/FurrowConfig.cmake ${CMAKE_BINARY_DIR}/package/FurrowConfigVersion.cmake
        ${CMAKE_CURRENT_LIST_DIR}/FindSuiteSparse.cmake DESTINATION lib/cmake/Furrow COMPONENT libraries)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scripts/example DESTINATION share/furrow COMPONENT libraries)

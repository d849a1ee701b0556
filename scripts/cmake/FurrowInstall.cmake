# What `cmake --install` puts where: a tree that may be moved, and hold builds for several instruction sets beside each
# other (scripts/install.sh). The program finds share/furrow/ from where it stands.
if(FURROW_NATIVE)
  set(_level native)
else()
  set(_level ${FURROW_LEVEL})
endif()
install(TARGETS furrow RUNTIME DESTINATION libexec/furrow/${_level})
install(PROGRAMS ${CMAKE_SOURCE_DIR}/scripts/cluster/furrow DESTINATION bin)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/README.md DESTINATION share/furrow)
foreach(_folder rigs tire/data terrain/data vehicle/data)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${_folder}/ DESTINATION share/furrow/${_folder} FILES_MATCHING PATTERN "*.json"
    PATTERN "*.csv")
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scripts/plot DESTINATION share/furrow/scripts FILES_MATCHING PATTERN "*.py")
install(PROGRAMS ${CMAKE_SOURCE_DIR}/scripts/report.py DESTINATION share/furrow/scripts)
set_target_properties(furrow PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)  # where this system has its libraries

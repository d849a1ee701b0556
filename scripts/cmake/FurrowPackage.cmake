# `cpack` in the build folder makes a Debian package of the program: furrow_<version>_<architecture>.deb.
# scripts/install.sh --deb makes the one to pass on, with a build for every level of processors. A build for the
# processor of this machine alone says so in the name of its file.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME furrow)
set(CPACK_PACKAGE_CONTACT "The Furrow authors <maintainers@furrow.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "co-simulation of flexible tires on granular terrain")
set(CPACK_PACKAGE_DESCRIPTION "Furrow simulates a flexible tire, or a vehicle, on soil made of grains.
It computes pull, sinkage and rut from the tire's layup and inflation pressure
and from the contacts between grains, on several ranks of MPI.")
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};furrow;program;/")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Beyond the libraries that it links: mpiexec starts the ranks, and Python draws plots and pages.
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, python3-h5py")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-pandas, python3-xarray")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
if(FURROW_NATIVE)
  execute_process(COMMAND dpkg --print-architecture OUTPUT_VARIABLE _architecture
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  set(CPACK_DEBIAN_FILE_NAME furrow_${PROJECT_VERSION}_${_architecture}_native.deb)
endif()
install(FILES ${CMAKE_CURRENT_LIST_DIR}/package/copyright DESTINATION share/doc/furrow)
# `cmake --build build --target package_source`: the archive of a release, which needs no git.
set(CPACK_SOURCE_GENERATOR TXZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME furrow-${PROJECT_VERSION})
set(CPACK_SOURCE_IGNORE_FILES "/\\.git/" "/build[^/]*/" "^${CMAKE_SOURCE_DIR}/results/" "__pycache__" "\\.tar\\.xz$"
  "/node_modules/" "\\.egg-info/")
include(CPack)

# What `cmake --install` puts where: a tree that may be moved, and hold builds for several instruction sets beside each
# other (scripts/install.sh). The program finds share/furrow/ from its own place. The component `program` is all that
# runs; FurrowLibraries.cmake adds the component `libraries`.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
if(FURROW_NATIVE)
  set(_level native)
else()
  set(_level ${FURROW_LEVEL})
endif()
install(TARGETS furrow RUNTIME DESTINATION libexec/furrow/${_level})
# Beside the program, where it is looked for. A component of its own: the Debian package does not pull in LIGGGHTS.
if(TARGET furrow_liggghts)
  install(TARGETS furrow_liggghts LIBRARY DESTINATION libexec/furrow/${_level} COMPONENT liggghts)
endif()
if(TARGET furrow_gpu)
  install(FILES ${CMAKE_BINARY_DIR}/libfurrow_gpu.so DESTINATION libexec/furrow/${_level} COMPONENT gpu)
endif()
install(PROGRAMS ${CMAKE_SOURCE_DIR}/scripts/cluster/furrow DESTINATION bin)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/README.md DESTINATION share/furrow)
# The pages that messages and README.md name, under their paths in the checkout.
file(GLOB_RECURSE _pages RELATIVE ${CMAKE_SOURCE_DIR} CONFIGURE_DEPENDS
  ${CMAKE_SOURCE_DIR}/nodes/*.md ${CMAKE_SOURCE_DIR}/rigs/*.md ${CMAKE_SOURCE_DIR}/vehicle/*.md
  ${CMAKE_SOURCE_DIR}/tire/*.md ${CMAKE_SOURCE_DIR}/terrain/*.md ${CMAKE_SOURCE_DIR}/protocol/*.md
  ${CMAKE_SOURCE_DIR}/tests/*.md ${CMAKE_SOURCE_DIR}/scripts/*.md)
foreach(_page GLOSSARY.md CONTRIBUTING.md CHANGELOG.md ${_pages})
  get_filename_component(_folder ${_page} DIRECTORY)
  install(FILES ${CMAKE_SOURCE_DIR}/${_page} DESTINATION share/furrow/${_folder})
endforeach()
foreach(_folder rigs tire/data terrain/data vehicle/data)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${_folder}/ DESTINATION share/furrow/${_folder} FILES_MATCHING PATTERN "*.json"
    PATTERN "*.csv")
endforeach()
# The Python package, which also draws plots and pages, and a link to it from where Debian's Python looks if the prefix
# is /usr.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scripts/python/furrow DESTINATION share/furrow/scripts/python
  PATTERN "*.md" EXCLUDE PATTERN __pycache__ EXCLUDE)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
file(CREATE_LINK ../../../share/furrow/scripts/python/furrow ${CMAKE_BINARY_DIR}/package/furrow SYMBOLIC)
install(FILES ${CMAKE_BINARY_DIR}/package/furrow DESTINATION lib/python3/dist-packages)
set_target_properties(furrow PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)  # where this system has its libraries

# Completion scripts and the manual page, made from the help of the program that is installed. A build for another
# processor cannot print its help: then those of an earlier level stay, or there are none.
find_program(FURROW_PYTHON NAMES python3 HINTS /usr/bin DOC "makes completion scripts and the manual page")
mark_as_advanced(FURROW_PYTHON)
function(furrow_install_made script argument target)
  install(CODE "
    execute_process(COMMAND \"${FURROW_PYTHON}\" -B \"${CMAKE_SOURCE_DIR}/scripts/docs/${script}\" ${argument}
      --program \"$<TARGET_FILE:furrow>\"
      OUTPUT_VARIABLE made RESULT_VARIABLE failed ERROR_QUIET)
    if(failed)
      message(STATUS \"Not made: ${target}\")
    else()
      message(STATUS \"Installing: \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${target}\")
      file(WRITE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${target}\" \"\${made}\")
    endif()")
endfunction()
furrow_install_made(completion.py bash share/bash-completion/completions/furrow)
furrow_install_made(completion.py zsh share/zsh/vendor-completions/_furrow)
furrow_install_made(completion.py fish share/fish/vendor_completions.d/furrow.fish)
furrow_install_made(manual.py "" share/man/man1/furrow.1)

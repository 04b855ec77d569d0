# `cmake --install` puts everything below the prefix; `cpack` makes the Debian package (prefix /usr, the configuration
# in /etc), which is what a vehicle installs.
include(GNUInstallDirs)

install(FILES config/landfixd.service DESTINATION lib/systemd/system)
install(FILES config/landfix.toml DESTINATION ${CMAKE_INSTALL_SYSCONFDIR}/landfix)
install(FILES config/landfix.dbc DESTINATION ${CMAKE_INSTALL_DATADIR}/landfix)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/landfix)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/landfix RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The landfix developers <landfix@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}/debian/move_configuration.cmake")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"landfixd tells a vehicle where it is, from its LiDAR alone: packets come in
over Ethernet, poses go out on the CAN bus. landfix makes its maps, replays
captures and checks the host. The method is the Normal Distributions
Transform (NDT).")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "systemd")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "can-utils, chrony | linuxptp")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  "${CMAKE_CURRENT_LIST_DIR}/debian/conffiles"
  "${CMAKE_CURRENT_LIST_DIR}/debian/postinst"
  "${CMAKE_CURRENT_LIST_DIR}/debian/prerm"
  "${CMAKE_CURRENT_LIST_DIR}/debian/postrm")
include(CPack)

# Configuration belongs in /etc, which is not below the prefix of the package.
file(RENAME "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/etc" "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/etc")

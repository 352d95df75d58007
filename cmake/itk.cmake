# ITK reads NRRD, MetaImage and DICOM. It is used where it is found, unless -DDELTASPLAT_ITK=OFF;
# with -DDELTASPLAT_ITK=ON it has to be found.
if(NOT DEFINED DELTASPLAT_ITK OR DELTASPLAT_ITK)
    include(cmake/find_itk.cmake)
endif()
option(DELTASPLAT_ITK "Read NRRD, MetaImage and DICOM (needs ITK 5)" ${ITK_FOUND})
if(DELTASPLAT_ITK AND NOT ITK_FOUND)
    message(FATAL_ERROR "DELTASPLAT_ITK is ON, but ITK 5 was not found; run "
                        "scripts/install_dependencies.sh or set it to OFF")
endif()

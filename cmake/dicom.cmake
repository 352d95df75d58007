# GDCM unpacks the pixels of DICOM, in the helper program. It is used where it is found, unless
# -DDELTASPLAT_DICOM=OFF; with -DDELTASPLAT_DICOM=ON it has to be found.
if(NOT DEFINED DELTASPLAT_DICOM OR DELTASPLAT_DICOM)
    include(cmake/find_gdcm.cmake)
endif()
option(DELTASPLAT_DICOM "Unpack the pixels of DICOM (needs GDCM 3)" ${GDCM_FOUND})
if(DELTASPLAT_DICOM AND NOT GDCM_FOUND)
    message(FATAL_ERROR "DELTASPLAT_DICOM is ON, but GDCM 3 was not found; run "
                        "scripts/install_dependencies.sh or set it to OFF")
endif()

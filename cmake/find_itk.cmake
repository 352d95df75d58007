# Looks for ITK and for GDCM, with which ITK reads DICOM; sets ITK_FOUND, DELTASPLAT_ITK_LIBRARIES and DELTASPLAT_ITK_INCLUDE_DIRS.
# ITK's package file loads all of its modules, whatever is asked for. Those that look for libraries
# which nothing here uses (HDF5 even needs the language C) are taken as loaded already.
set(ITK_FOUND FALSE)
block(PROPAGATE ITK_FOUND ITK_DIR DELTASPLAT_ITK_LIBRARIES DELTASPLAT_ITK_INCLUDE_DIRS)
    set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
    foreach(module ITKDCMTK ITKHDF5 ITKMINC)
        set(${module}_LOADED TRUE)
    endforeach()
    find_package(ITK 5 QUIET COMPONENTS ITKGDCM ITKIOMeta ITKIONRRD)
    set(DELTASPLAT_ITK_LIBRARIES ITKIOMeta ITKIONRRD gdcmMSFF)
    set(DELTASPLAT_ITK_INCLUDE_DIRS ${ITK_INCLUDE_DIRS} ${ITKGDCM_INCLUDE_DIRS})
    list(REMOVE_ITEM DELTASPLAT_ITK_INCLUDE_DIRS /usr/include)
    foreach(library ${DELTASPLAT_ITK_LIBRARIES})
        if(NOT TARGET ${library})
            set(ITK_FOUND FALSE)
        endif()
    endforeach()
endblock()

// SPDX-License-Identifier: Apache-2.0
// Unpacks pixels by GDCM, whose codecs end the process or make pixels up where these are damaged.
#include <gdcmImage.h>
#include <gdcmImageReader.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "formats/dicom/dicom_stream.h"
#include "helper_work.h"

namespace deltasplat {
namespace {

// Has malloc clear the memory that it returns: codecs hand on memory which damaged pixels leave
// unwritten, and one file is always to give the same voxels.
void clearMemory() {
#ifdef __GLIBC__
    constexpr int kComplementOfZero = 0xff;
    mallopt(M_PERTURB, kComplementOfZero);
#endif
}

gdcm::PixelFormat formatOf(const DicomUnpacking& what) {
    using Number = unsigned short;
    return gdcm::PixelFormat(1, Number(what.allocated), Number(what.stored),
                             Number(what.stored - 1), what.isSigned ? 1 : 0);
}

// libjpeg, inside of GDCM, makes up what a code stream lacks, and prints that it did.
bool hasPrinted() {
    std::fflush(stderr);
    struct stat status {};
    return ::fstat(STDERR_FILENO, &status) != 0 || status.st_size != 0;
}

bool unpackPixels(const DicomUnpacking& what, const std::string& file, std::string& to) {
    std::istringstream in(file);
    gdcm::ImageReader reader;
    reader.SetStream(in);
    if (!reader.Read()) return false;
    const gdcm::Image& image = reader.GetImage();
    const unsigned* dims = image.GetDimensions();
    to.resize(std::size_t(what.bytes));
    return dims[0] == unsigned(what.columns) && dims[1] == unsigned(what.rows) &&
           image.GetPixelFormat() == formatOf(what) && image.GetBufferLength() == what.bytes &&
           image.GetBuffer(to.data()) && !hasPrinted();
}

}  // namespace
}  // namespace deltasplat

bool deltasplat_helper_work(std::string_view request, std::string& answer, deltasplat::HelperNote) {
    deltasplat::clearMemory();
    deltasplat::DicomUnpacking what;
    if (request.size() < sizeof what) return false;
    std::memcpy(&what, request.data(), sizeof what);
    return deltasplat::unpackPixels(what, std::string(request.substr(sizeof what)), answer);
}

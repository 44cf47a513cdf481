#include <refused.hpp>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/numpy_raster.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace zip_directory_test {

// Printed in: catalogues of CRCs, the check value of CRC-32/ISO-HDLC.
TEST(ZipDirectory, ChecksumMatchesCrc32) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32(""), 0U);
}

TEST(ZipDirectory, FileWithoutDirectoryIsRejected) {
  const TemporaryFolder folder;
  for (const std::string& bytes :
       {std::string("x"), std::string(100, 'x'), "PK\5\6" + std::string(18, '\xff')})
    EXPECT_REFUSED(zipDirectory(folder.write("a.npz", bytes)), InputError,
                   "its directory of files is damaged or missing");
}

}  // namespace zip_directory_test
}  // namespace talus::maps

#include "eulumdat.h"

#include "importers/photometry/scene.h"
#include "reader.h"

namespace etendue {

Result<PhotometricFile> read_eulumdat(std::span<const std::byte> bytes, const std::string& file, const PhotometricOptions& options) {
  try {
    PhotometricFile result;
    std::string storage;
    const Result<std::string_view> text = photometric::decode(bytes, file, storage, result.diagnostics);
    if (!text) return text.error();
    eulumdat::Reader reader(*text, file, options, result.diagnostics);
    if (!reader.read(result.distribution)) return reader.error();
    return result;
  } catch (const std::bad_alloc&) {
    return Error{"FILE_TOO_LARGE", "there is not enough memory for the intensities", {file, 0, 0, {}}, "read it on a larger machine", {}};
  }
}

namespace {

class EulumdatImporter final : public Importer {
 public:
  FormatInfo describe() const override {
    return {"eulumdat", "EULUMDAT", {".ldt"}, "Luminous intensity of a luminaire over direction per 1000 lm of its lamps"};
  }

  // No magic: lines 2 to 7 are numbers, the second and third of them small.
  int sniff(std::span<const std::byte> head) const override {
    const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    const char* p = text.data();
    const char* const end = p + text.size();
    (void)photometric::take_line(p, end);
    for (int line = 2; line <= 7; ++line) {
      const std::string_view field = photometric::trimmed(photometric::take_line(p, end));
      double number = 0;
      if (field.empty() || photometric::parse_number(field.data(), field.data() + field.size(), number) == nullptr) return 0;
      if (number < 0 || (line <= 3 && number > 4)) return 0;
    }
    return 70;
  }

  Result<Imported> read(const std::filesystem::path& file, const ImportOptions& options) const override {
    return photometric::read_scene(file, options, "eulumdat", &read_eulumdat);
  }
};

}  // namespace

std::unique_ptr<Importer> make_eulumdat_importer() { return std::make_unique<EulumdatImporter>(); }

}  // namespace etendue

#include "ies.h"

#include "importers/photometry/scene.h"
#include "reader.h"

namespace etendue {

Result<PhotometricFile> read_ies(std::span<const std::byte> bytes, const std::string& file, const PhotometricOptions& options) {
  try {
    PhotometricFile result;
    std::string storage;
    const Result<std::string_view> text = photometric::decode(bytes, file, storage, result.diagnostics);
    if (!text) return text.error();
    ies::Reader reader(*text, file, options, result.diagnostics);
    if (!reader.read(result.distribution)) return reader.error();
    return result;
  } catch (const std::bad_alloc&) {
    return Error{"FILE_TOO_LARGE", "there is not enough memory for the candelas", {file, 0, 0, {}}, "read it on a larger machine", {}};
  }
}

namespace {

class IesImporter final : public Importer {
 public:
  FormatInfo describe() const override {
    return {"ies", "IES LM-63", {".ies"}, "Luminous intensity of a luminaire over direction, 1986 to 2019, web types A, B and C"};
  }

  int sniff(std::span<const std::byte> head) const override {
    const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    if (text.starts_with("IESNA") || text.starts_with("IES:LM-63")) return 100;
    return text.find("TILT=") != std::string_view::npos ? 90 : 0;
  }

  Result<Imported> read(const std::filesystem::path& file, const ImportOptions& options) const override {
    return photometric::read_scene(file, options, "ies", &read_ies);
  }
};

}  // namespace

std::unique_ptr<Importer> make_ies_importer() { return std::make_unique<IesImporter>(); }

}  // namespace etendue

// The keys of a metadata file, wherever its layout has them, and errors that say where they are. Included by
// the parser alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace landfix::drivers::ouster {

class MetadataJson {
 public:
  /// Throws std::runtime_error where it is no JSON object, nested too deep or too large to be metadata.
  MetadataJson(std::span<const std::byte> file, std::string_view name);

  /// The value of `key` in the first of `sections` that has it, or, flat, at the top. Null where there is
  /// none: a section that is not an object is absent (firmware 1.12 answers new clients with the string
  /// "error: Command not recognized.").
  [[nodiscard]] const nlohmann::json* find(std::initializer_list<const char*> sections,
                                           const char* key) const;

  // The same, of a type. Throw std::runtime_error where the value is of another.
  [[nodiscard]] std::optional<std::string> text(std::initializer_list<const char*> sections,
                                                const char* key) const;
  [[nodiscard]] std::optional<double> number(std::initializer_list<const char*> sections, const char* key,
                                             double least, double most) const;
  [[nodiscard]] std::optional<std::size_t> count(std::initializer_list<const char*> sections, const char* key,
                                                 std::size_t least, std::size_t most) const;
  /// Between `least` and `most`, each of them.
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::initializer_list<const char*> sections,
                                                           const char* key, double least, double most) const;

  /// Throws std::runtime_error "NAME:LINE: KEY: `what`", with the line of the key, or without where it is
  /// missing.
  [[noreturn]] void fail(const char* key, const std::string& what) const;

 private:
  std::string_view text_;
  std::string name_;
  nlohmann::json root_;
};

}  // namespace landfix::drivers::ouster

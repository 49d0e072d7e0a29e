#pragma once

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// An enumeration with a function `names_of(E)` beside it that returns a range of (value, name) pairs.
template <class E>
concept NamedEnum = std::is_enum_v<E> && requires(E e) {
  names_of(e).begin()->first == e;
  std::string(names_of(e).begin()->second);
};

/// How a type of option looks as text, on the command line as in files: `print` what `parse` gives back to the last
/// bit, nothing where the text is not understood, and `expected` says what would be. Specialise it for new types.
template <class T>
struct TextValue;

template <>
struct TextValue<bool> {
  static std::string print(bool value) { return value ? "true" : "false"; }
  static std::optional<bool> parse(std::string_view text) {
    if (text == "true" || text == "yes" || text == "on") return true;
    if (text == "false" || text == "no" || text == "off") return false;
    return std::nullopt;
  }
  static std::string expected() { return "true or false"; }
};

template <std::integral T>
struct TextValue<T> {
  static std::string print(T value) { return fmt::format("{}", value); }
  static std::optional<T> parse(std::string_view text) {
    const auto in_range = [](auto value) {
      return value && std::in_range<T>(*value) ? std::optional<T>(static_cast<T>(*value)) : std::nullopt;
    };
    if constexpr (std::is_unsigned_v<T>) return in_range(to_unsigned(text));
    return in_range(to_integer(text));
  }
  static std::string expected() {
    return std::is_unsigned_v<T> ? "a whole number, not negative"
                                 : fmt::format("a whole number of at most {}", std::numeric_limits<T>::max());
  }
};

template <>
struct TextValue<double> {
  static std::string print(double value) { return fmt::format("{}", value); }
  static std::optional<double> parse(std::string_view text) {
    const auto value = to_double(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
  }
  static std::string expected() { return "a finite number"; }
};

template <>
struct TextValue<PixelValue> {
  static std::string print(PixelValue pixel) { return fmt::format("{}", pixel.value); }
  static std::optional<PixelValue> parse(std::string_view text) {
    const auto value = to_double(text);
    return value && !std::isnan(*value) ? std::optional(PixelValue{*value}) : std::nullopt;
  }
  static std::string expected() { return "a number or inf"; }
};

template <>
struct TextValue<std::string> {
  static std::string print(const std::string& value) { return value; }
  static std::optional<std::string> parse(std::string_view text) { return std::string(text); }
  static std::string expected() { return "a text"; }
};

/// Fixed-size vectors as `x,y,z`; blanks around the commas do not matter.
template <class Scalar, int Count>
struct TextValue<Eigen::Matrix<Scalar, Count, 1>> {
  using Vector = Eigen::Matrix<Scalar, Count, 1>;

  static std::string print(const Vector& value) {
    std::string text;
    for (int i = 0; i < Count; ++i) text.append(i == 0 ? "" : ",").append(TextValue<Scalar>::print(value[i]));
    return text;
  }
  static std::optional<Vector> parse(std::string_view text) {
    Vector value;
    for (int i = 0; i < Count; ++i) {
      const std::size_t comma = text.find(',');
      if ((comma == std::string_view::npos) != (i + 1 == Count)) return std::nullopt;
      const auto number = TextValue<Scalar>::parse(trimmed(text.substr(0, comma)));
      if (!number) return std::nullopt;
      value[i] = *number;
      text.remove_prefix(i + 1 == Count ? text.size() : comma + 1);
    }
    return value;
  }
  static std::string expected() {
    return fmt::format("{} {}numbers separated by commas", Count, std::is_integral_v<Scalar> ? "whole " : "");
  }
};

template <>
struct TextValue<Resolution> {
  static std::string print(Resolution value) { return fmt::format("{}x{}", value.columns, value.rows); }
  static std::optional<Resolution> parse(std::string_view text) {
    const std::size_t x = text.find('x');
    if (x == std::string_view::npos) return std::nullopt;
    const auto columns = TextValue<int>::parse(text.substr(0, x));
    const auto rows = TextValue<int>::parse(text.substr(x + 1));
    if (!columns || !rows || *columns < 1 || *rows < 1) return std::nullopt;
    return Resolution{*columns, *rows};
  }
  static std::string expected() { return "COLUMNSxROWS, both positive"; }
};

/// `A,B`, or `A,B,C` where there is a third part.
template <>
struct TextValue<DepthDeviation> {
  static std::string print(const DepthDeviation& value) {
    using Two = Eigen::Vector2d;
    return value.c == 0 ? TextValue<Two>::print({value.a, value.b})
                        : TextValue<Vec3>::print({value.a, value.b, value.c});
  }
  static std::optional<DepthDeviation> parse(std::string_view text) {
    if (const auto two = TextValue<Eigen::Vector2d>::parse(text)) return DepthDeviation{two->x(), two->y()};
    const auto three = TextValue<Vec3>::parse(text);
    return three ? std::optional(DepthDeviation{three->x(), three->y(), three->z()}) : std::nullopt;
  }
  static std::string expected() { return "2 or 3 numbers separated by commas"; }
};

template <NamedEnum E>
struct TextValue<E> {
  static std::string print(E value) {
    for (const auto& [entry, name] : names_of(value)) {
      if (entry == value) return std::string(name);
    }
    return {};
  }
  static std::optional<E> parse(std::string_view text) {
    for (const auto& [entry, name] : names_of(E{})) {
      if (text == name) return entry;
    }
    return std::nullopt;
  }
  static std::string expected() {
    std::string text = "one of";
    for (const auto& [entry, name] : names_of(E{})) text.append(text.size() > 6 ? ", " : " ").append(name);
    return text;
  }
};

/// An option may be without a value; it then reads `none`.
inline constexpr std::string_view no_value = "none";

}  // namespace vantage

// Saves and restores the state of a running computation: binary, little-endian, numbers bit by bit.
//
// What has state lists it once, for both ways:
//   template <class Archive>
//   void visit(Archive& archive) { archive(time_, positions_, counter_); }
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace flowskin {

static_assert(std::endian::native == std::endian::little, "states are saved as they lie in memory: little-endian");

/// A saved state is cut short, or is not that of what is to be restored.
struct StateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

namespace state {

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// An Eigen matrix or vector of fixed size without padding.
template <class T>
concept FixedMatrix = requires {
  typename T::Scalar;
  requires std::is_base_of_v<Eigen::PlainObjectBase<T>, T>;
  requires(int(T::SizeAtCompileTime) > 0 &&
           sizeof(T) == std::size_t(T::SizeAtCompileTime) * sizeof(typename T::Scalar));
};

template <class T>
concept DynamicMatrix = requires {
  typename T::Scalar;
  requires std::is_base_of_v<Eigen::PlainObjectBase<T>, T>;
  requires(int(T::SizeAtCompileTime) == Eigen::Dynamic);
};

/// A struct that says with `using plain_numbers = float;` that it holds nothing but numbers of this type.
template <class T>
concept PlainStruct = requires {
  typename T::plain_numbers;
  requires std::is_trivially_copyable_v<T>;
};

/// Saved as the bytes that it is made of: no padding, no pointers.
template <class T>
struct IsPlain : std::bool_constant<Number<T> || FixedMatrix<T> || PlainStruct<T>> {};
template <class T, std::size_t N>
struct IsPlain<std::array<T, N>> : IsPlain<T> {};
template <class T>
concept Plain = IsPlain<T>::value;

/// Lists its fields. (Eigen's matrices have another visit().)
template <class T, class Archive>
concept Visited = !FixedMatrix<T> && !DynamicMatrix<T> && requires(T & value, Archive& archive) {
  value.visit(archive);
};

}  // namespace state

/// Writes values, in large pieces, to whoever wants the bytes.
class StateWriter {
 public:
  explicit StateWriter(std::function<void(std::string_view)> sink) : sink_(std::move(sink)) {}
  /// Hands on what is left. Call it at the end.
  void flush() {
    sink_(buffer_);
    buffer_.clear();
  }

  template <class... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }
  /// A name that the reader must find at this place.
  void section(std::string_view name) { write(std::string(name)); }
  /// The state of parts that are there already when it is read: their number stays.
  template <class Range>
  void each(const Range& parts) {
    write(static_cast<std::uint64_t>(parts.size()));
    for (const auto& part : parts) write(part);
  }

 private:
  static constexpr std::size_t kPiece = 1 << 20;  // bytes

  void bytes(const void* data, std::size_t size) {
    if (buffer_.size() + size > kPiece) flush();
    if (size > kPiece) {
      sink_({static_cast<const char*>(data), size});
    } else if (size > 0) {
      buffer_.append(static_cast<const char*>(data), size);
    }
  }

  template <state::Plain T>
  void write(const T& value) {
    bytes(&value, sizeof value);
  }
  template <state::DynamicMatrix T>
  void write(const T& value) {
    write(static_cast<std::uint64_t>(value.rows()));
    write(static_cast<std::uint64_t>(value.cols()));
    bytes(value.data(), static_cast<std::size_t>(value.size()) * sizeof(typename T::Scalar));
  }
  // visit() serves both ways and so cannot be const; writing changes nothing.
  template <state::Visited<StateWriter> T>
  void write(const T& value) {
    const_cast<T&>(value).visit(*this);
  }
  void write(const std::string& value) {
    write(static_cast<std::uint64_t>(value.size()));
    bytes(value.data(), value.size());
  }
  template <class T>
  void write(const std::vector<T>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    if constexpr (state::Plain<T> && !std::is_same_v<T, bool>) {
      bytes(values.data(), values.size() * sizeof(T));
    } else {
      for (const T& value : values) write(value);
    }
  }
  template <class T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  template <class A, class B>
  void write(const std::pair<A, B>& value) {
    write(value.first);
    write(value.second);
  }
  template <class K, class V>
  void write(const std::map<K, V>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    for (const auto& [key, value] : values) {
      write(key);
      write(value);
    }
  }
  // In the order of the keys: the same bytes for the same content.
  template <class K, class V>
  void write(const std::unordered_map<K, V>& values) {
    std::vector<const std::pair<const K, V>*> entries;
    entries.reserve(values.size());
    for (const auto& entry : values) entries.push_back(&entry);
    std::sort(entries.begin(), entries.end(), [](const auto* a, const auto* b) { return a->first < b->first; });
    write(static_cast<std::uint64_t>(entries.size()));
    for (const auto* entry : entries) {
      write(entry->first);
      write(entry->second);
    }
  }

  std::function<void(std::string_view)> sink_;
  std::string buffer_;
};

/// Reads what a StateWriter wrote. Whatever the bytes are, it throws rather than read or allocate beyond them.
class StateReader {
 public:
  /// `bytes` must outlive the reader.
  explicit StateReader(std::string_view bytes) : left_(bytes) {}

  /// @throws StateError
  template <class... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }
  void section(std::string_view name) {
    std::string found;
    read(found);
    if (found != name)
      throw StateError("the saved state has \"" + found.substr(0, 40) + "\" where \"" + std::string(name) +
                       "\" is expected");
  }
  template <class Range>
  void each(Range& parts) {
    if (count(0) != parts.size()) throw StateError("the saved state has another number of parts than the set-up");
    for (auto& part : parts) read(part);
  }
  std::size_t bytes_left() const { return left_.size(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > left_.size()) throw StateError("the saved state ends too early");
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }
  void bytes(void* data, std::size_t size) {
    if (size > 0) std::memcpy(data, take(size).data(), size);
  }
  /// A number of things that take so many bytes each, at least.
  std::size_t count(std::size_t bytes_each) {
    std::uint64_t value = 0;
    read(value);
    if (value > left_.size() / std::max<std::size_t>(1, bytes_each)) throw StateError("the saved state ends too early");
    return static_cast<std::size_t>(value);
  }

  template <state::Plain T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = take(1).front() != 0;
    } else {
      bytes(&value, sizeof value);
    }
  }
  template <state::DynamicMatrix T>
  void read(T& value) {
    const std::size_t rows = count(0), columns = count(rows * sizeof(typename T::Scalar));
    value.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    bytes(value.data(), rows * columns * sizeof(typename T::Scalar));
  }
  template <state::Visited<StateReader> T>
  void read(T& value) {
    value.visit(*this);
  }
  void read(std::string& value) {
    const std::size_t size = count(1);
    value = take(size);
  }
  template <class T>
  void read(std::vector<T>& values) {
    if constexpr (state::Plain<T> && !std::is_same_v<T, bool>) {
      values.resize(count(sizeof(T)));
      bytes(values.data(), values.size() * sizeof(T));
    } else {
      values.clear();
      for (std::size_t left = count(1); left > 0; --left) {
        T value{};
        read(value);
        values.push_back(std::move(value));
      }
    }
  }
  template <class T>
  void read(std::optional<T>& value) {
    bool has_value = false;
    read(has_value);
    value.reset();
    if (has_value) read(value.emplace());
  }
  template <class A, class B>
  void read(std::pair<A, B>& value) {
    read(value.first);
    read(value.second);
  }
  template <class Map>
  void read_map(Map& values) {
    values.clear();
    for (std::size_t left = count(1); left > 0; --left) {
      typename Map::key_type key{};
      typename Map::mapped_type value{};
      read(key);
      read(value);
      values.emplace(std::move(key), std::move(value));
    }
  }
  template <class K, class V>
  void read(std::map<K, V>& values) {
    read_map(values);
  }
  template <class K, class V>
  void read(std::unordered_map<K, V>& values) {
    read_map(values);
  }

  std::string_view left_;
};

}  // namespace flowskin

/// The columns of rows of numbers: names, types, and records of packed numbers.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace hedgerow {

/// The columns that rows to be read must have, by name.
struct InputColumns {
    std::vector<std::string> names;
    /// Values of the last columns, which a file may leave out, all together.
    std::vector<double> defaults = {};

    std::size_t size() const { return names.size(); }
    std::size_t required() const { return names.size() - defaults.size(); }
};

/// The type of the numbers in a column. An id is a `std::uint32_t`, of which 2^32 − 1 stands for none. A sign
/// is a `std::int8_t`, of which −128 stands for none.
enum class NumberType : unsigned char { flag, id, count, f32, f64, sign };

template <class N>
constexpr NumberType number_type() {
    if constexpr (std::is_same_v<N, bool>) return NumberType::flag;
    if constexpr (std::is_same_v<N, std::uint32_t>) return NumberType::id;
    if constexpr (std::is_same_v<N, std::uint64_t>) return NumberType::count;
    if constexpr (std::is_same_v<N, float>) return NumberType::f32;
    if constexpr (std::is_same_v<N, std::int8_t>) return NumberType::sign;
    return NumberType::f64;
}
/// Bytes of a number in a record.
constexpr std::size_t size_of(NumberType type) {
    constexpr std::size_t sizes[] = {1, 4, 8, 4, 8, 1};
    return sizes[static_cast<std::size_t>(type)];
}

/// A column of rows that are written.
struct Column {
    std::string name;
    NumberType type;
};

/// Collects the columns of an answer: `list_columns(Hit<float>(), list)` (columns.h).
struct ColumnList {
    std::vector<Column> all;
    template <class N>
    void operator()(std::string_view name, N) {
        all.push_back({std::string(name), number_type<N>()});
    }
};

/// A record: numbers in this processor's byte order, one after the other without gaps, from a place in memory
/// on.
class Record {
public:
    static constexpr std::size_t most = 128;  // bytes: 16 columns of any type

    explicit Record(char* at) : at_(at) {}
    template <class N>
    void operator()(std::string_view, N value) {
        static_assert(sizeof(N) == size_of(number_type<N>()));
        std::memcpy(at_, &value, sizeof(N));
        at_ += sizeof(N);
    }
    const char* end() const { return at_; }

private:
    char* at_;
};
/// Counts the bytes of a record.
struct RecordSize {
    std::size_t bytes = 0;
    template <class N>
    void operator()(std::string_view, N) {
        bytes += size_of(number_type<N>());
    }
};

/// Appends a record to `records`. `list(record)` gives its numbers: `record(name, number)` for each column.
template <class List>
void append_record(std::string& records, List list) {
    char bytes[Record::most];
    Record record(bytes);
    list(record);
    records.append(bytes, static_cast<std::size_t>(record.end() - bytes));
}
/// Appends `count` records of `size` bytes each, of which `list(i, record)` gives the numbers.
template <class List>
void append_records(std::string& records, std::size_t count, std::size_t size, List list) {
    const std::size_t before = records.size();
    records.resize(before + count * size);
    for (std::size_t i = 0; i < count; ++i) {
        Record record(records.data() + before + i * size);
        list(i, record);
    }
}

}  // namespace hedgerow

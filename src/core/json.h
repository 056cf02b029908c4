#pragma once

#include "fppg/error.h"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fppg
{

/// A text that is no JSON, or a value that is missing or of another type; the text says which.
class JsonError : public Error
{
public:
    using Error::Error;
};

/// A value of JSON; members of an object keep their order. nlohmann/json reads and writes it: that
/// header takes seconds to compile wherever it is used, so only json.cpp includes it.
class Json
{
public:
    enum class Kind
    {
        Null,
        Bool,
        Signed,
        Unsigned,
        Real,
        Text,
        Array,
        Object
    };

    Json(std::nullptr_t = nullptr);
    Json(bool value);
    Json(double value); ///< infinities and NaN are written as null
    Json(const char* value);
    Json(std::string_view value);
    Json(std::string value);
    template <std::signed_integral T>
    Json(T value) : Json(Kind::Signed)
    {
        bits_ = static_cast<std::uint64_t>(std::int64_t{value});
    }
    template <std::unsigned_integral T>
    Json(T value) : Json(Kind::Unsigned)
    {
        bits_ = value;
    }
    template <class T>
    Json(const std::vector<T>& values) : Json(Kind::Array)
    {
        for (const T& value : values) items_.emplace_back(value);
    }
    template <class T, std::size_t n>
    Json(const std::array<T, n>& values) : Json(Kind::Array)
    {
        for (const T& value : values) items_.emplace_back(value);
    }
    template <class A, class B>
    Json(const std::pair<A, B>& values) : Json(Kind::Array)
    {
        items_.emplace_back(values.first);
        items_.emplace_back(values.second);
    }
    /// An object where every value is a pair of a text and another value, otherwise an array.
    Json(std::initializer_list<Json> values);

    Json(const Json&);
    Json(Json&&) noexcept;
    Json& operator=(const Json&);
    Json& operator=(Json&&) noexcept;
    ~Json();

    static Json array() { return Json(Kind::Array); }
    static Json object() { return Json(Kind::Object); }
    /// throws  JsonError
    static Json parse(const std::string& text);
    static Json parse(std::istream& in);

    /// indent  blanks a level; -1: all on one line. Bytes that are not UTF-8 are replaced.
    std::string text(int indent = -1) const;

    /// Adds to an array; null becomes one.
    void push_back(Json value);
    /// A member of an object, null where it is new; null becomes an object.
    Json& operator[](std::string_view name);

    /// throws  JsonError where this is no object or has no such member
    const Json& at(std::string_view name) const;
    /// Values of an array.
    ///
    /// throws  JsonError where this is none
    const std::vector<Json>& items() const;
    /// Names and values of an object, in order.
    ///
    /// throws  JsonError where this is none
    std::vector<std::pair<std::string, Json>> members() const;

    /// Each throws JsonError where the value is of another type.
    void get_to(bool& value) const;
    void get_to(int& value) const;
    void get_to(std::uint64_t& value) const;
    void get_to(double& value) const;
    void get_to(std::string& value) const;
    template <class A, class B>
    void get_to(std::pair<A, B>& values) const
    {
        expect_items(2);
        items_[0].get_to(values.first);
        items_[1].get_to(values.second);
    }
    template <class T>
    void get_to(std::vector<T>& values) const
    {
        values.clear();
        for (const Json& item : items()) item.get_to(values.emplace_back());
    }
    template <class T>
    T get() const
    {
        T value{};
        get_to(value);
        return value;
    }

private:
    /// The value as nlohmann/json has it, and back; for json.cpp.
    struct Converter;

    explicit Json(Kind kind);
    void expect_items(std::size_t n) const;

    Kind kind_;
    std::uint64_t bits_ = 0; ///< of a bool or whole number
    double real_ = 0;
    std::string text_;
    std::vector<Json> items_;        ///< of an array or object
    std::vector<std::string> names_; ///< of an object, one an item
};

} // namespace fppg

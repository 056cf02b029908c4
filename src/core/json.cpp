#include "core/json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <istream>
#include <iterator>
#include <limits>

namespace fppg
{

using Library = nlohmann::ordered_json;

struct Json::Converter
{
    static Library out(const Json& json)
    {
        switch (json.kind_)
        {
            case Kind::Null:
                break;
            case Kind::Bool:
                return json.bits_ != 0;
            case Kind::Signed:
                return static_cast<std::int64_t>(json.bits_);
            case Kind::Unsigned:
                return json.bits_;
            case Kind::Real:
                return json.real_;
            case Kind::Text:
                return json.text_;
            case Kind::Array:
            {
                Library array = Library::array();
                for (const Json& item : json.items_) array.push_back(out(item));
                return array;
            }
            case Kind::Object:
            {
                Library object = Library::object();
                for (std::size_t i = 0; i < json.items_.size(); ++i)
                    object[json.names_[i]] = out(json.items_[i]);
                return object;
            }
        }
        return nullptr;
    }

    static Json in(const Library& value)
    {
        switch (value.type())
        {
            case Library::value_t::boolean:
                return value.get<bool>();
            case Library::value_t::number_integer:
                return value.get<std::int64_t>();
            case Library::value_t::number_unsigned:
                return value.get<std::uint64_t>();
            case Library::value_t::number_float:
                return value.get<double>();
            case Library::value_t::string:
                return value.get<std::string>();
            case Library::value_t::array:
            {
                Json array = Json::array();
                for (const Library& item : value) array.items_.push_back(in(item));
                return array;
            }
            case Library::value_t::object:
            {
                Json object = Json::object();
                for (const auto& [name, member] : value.items()) object[name] = in(member);
                return object;
            }
            default:
                return nullptr;
        }
    }
};

Json::Json(Kind kind) : kind_(kind) {}

Json::Json(std::nullptr_t) : kind_(Kind::Null) {}

Json::Json(bool value) : kind_(Kind::Bool), bits_(value ? 1 : 0) {}

Json::Json(double value) : kind_(Kind::Real), real_(value) {}

Json::Json(const char* value) : kind_(Kind::Text), text_(value) {}

Json::Json(std::string_view value) : kind_(Kind::Text), text_(value) {}

Json::Json(std::string value) : kind_(Kind::Text), text_(std::move(value)) {}

Json::Json(std::initializer_list<Json> values) : kind_(Kind::Object)
{
    const auto is_member = [](const Json& value)
    {
        return value.kind_ == Kind::Array && value.items_.size() == 2 &&
               value.items_[0].kind_ == Kind::Text;
    };
    if (!std::all_of(values.begin(), values.end(), is_member))
    {
        kind_ = Kind::Array;
        items_ = values;
        return;
    }
    for (const Json& value : values) (*this)[value.items_[0].text_] = value.items_[1];
}

Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

Json Json::parse(const std::string& text)
{
    try
    {
        return Converter::in(Library::parse(text));
    }
    catch (const Library::exception& error)
    {
        throw JsonError(error.what());
    }
}

Json Json::parse(std::istream& in)
{
    return parse(std::string(std::istreambuf_iterator<char>(in), {}));
}

std::string Json::text(int indent) const
{
    return Converter::out(*this).dump(indent, ' ', false, Library::error_handler_t::replace);
}

void Json::push_back(Json value)
{
    if (kind_ == Kind::Null) kind_ = Kind::Array;
    if (kind_ != Kind::Array) throw JsonError("expected an array");
    items_.push_back(std::move(value));
}

Json& Json::operator[](std::string_view name)
{
    if (kind_ == Kind::Null) kind_ = Kind::Object;
    if (kind_ != Kind::Object) throw JsonError("expected an object");
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return items_[static_cast<std::size_t>(found - names_.begin())];
    names_.emplace_back(name);
    return items_.emplace_back();
}

const Json& Json::at(std::string_view name) const
{
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) throw JsonError(fmt::format("\"{}\" is missing", name));
    return items_[static_cast<std::size_t>(found - names_.begin())];
}

std::vector<std::pair<std::string, Json>> Json::members() const
{
    if (kind_ != Kind::Object) throw JsonError("expected an object");
    std::vector<std::pair<std::string, Json>> out;
    for (std::size_t i = 0; i < items_.size(); ++i) out.emplace_back(names_[i], items_[i]);
    return out;
}

const std::vector<Json>& Json::items() const
{
    if (kind_ != Kind::Array) throw JsonError("expected an array");
    return items_;
}

void Json::expect_items(std::size_t n) const
{
    if (items().size() != n)
        throw JsonError(fmt::format("{} values, expected {}", items_.size(), n));
}

void Json::get_to(bool& value) const
{
    if (kind_ != Kind::Bool) throw JsonError("expected true or false");
    value = bits_ != 0;
}

void Json::get_to(int& value) const
{
    const auto number = static_cast<std::int64_t>(bits_);
    if ((kind_ != Kind::Signed && kind_ != Kind::Unsigned) ||
        number < std::numeric_limits<int>::min() || number > std::numeric_limits<int>::max())
        throw JsonError("expected a whole number");
    value = static_cast<int>(number);
}

void Json::get_to(std::uint64_t& value) const
{
    if (kind_ != Kind::Unsigned) throw JsonError("expected a whole number from 0 on");
    value = bits_;
}

void Json::get_to(double& value) const
{
    switch (kind_)
    {
        case Kind::Real:
            value = real_;
            return;
        case Kind::Unsigned:
            value = static_cast<double>(bits_);
            return;
        case Kind::Signed:
            value = static_cast<double>(static_cast<std::int64_t>(bits_));
            return;
        default:
            throw JsonError("expected a number");
    }
}

void Json::get_to(std::string& value) const
{
    if (kind_ != Kind::Text) throw JsonError("expected a text");
    value = text_;
}

} // namespace fppg

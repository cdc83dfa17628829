/// The questions of the table behind one type each: what they are, for people and for bindings, and their
/// answers to rows of numbers, for files and arrays.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/base/option.h>
#include <hedgerow/columns.h>

namespace hedgerow {

/// An option of a question, without which it may not be asked if it is needed.
struct QuestionOption : OptionInfo {
    bool needed = false;
};

/// What a question is.
struct QuestionInfo {
    std::string_view name;             ///< "closest-point"
    std::string_view variant;          ///< of questions of one name: "feature", "radius", or none
    std::string_view words, meaning;   ///< in a sentence; what is answered
    std::string_view function, batch;  ///< of ask.h, that ask it once and many times
    InputColumns asked;                ///< the numbers of a row
    std::vector<Column> answered;      ///< those of a row that answers
    bool lists = false;                ///< whether any number of rows answers one, each with its number first
    std::vector<QuestionOption> options;
    /// Which sets answer it: `of_rays` not points, `of_facets` triangles in space and segments in the plane
    /// alone. What is `of_solid` is asked of the solid of an index.
    bool of_rays = false, of_facets = false, of_solid = false;

    /// The option of a name, or nullptr.
    const QuestionOption* option(std::string_view named) const {
        for (const QuestionOption& o : options)
            if (o.name == named) return &o;
        return nullptr;
    }
};
/// What a column of a row or an answer is, with its unit: "the distance, in units of the scene". Columns of
/// the axes follow their first part, "x" or "low_x". Empty for a name that no question has.
std::string_view meaning_of_column(std::string_view name);

/// The answers to some rows.
struct AnsweredRows {
    std::string records;         ///< append_record (base/column.h), of the columns that answer
    std::uint64_t rows = 0;      ///< how many records
    std::uint64_t unusable = 0;  ///< rows read that can have no answer
    std::uint64_t first_unusable = 0;

    void refuse(std::uint64_t row) {
        if (unusable++ == 0) first_unusable = row;
    }
};

/// What rows are asked of.
template <std::floating_point T, int D>
struct RowsAsked {
    const AnyIndex<T, D>& index;
    /// The solid of the index (`AnyIndex::make_solid` by options.solid), for questions `of_solid`.
    const AnySolid<T, D>* solid = nullptr;
    RowOptions options = {};
    /// The number that each primitive has for the reader, where that is another than the index reports.
    std::span<const std::uint32_t> numbers = {};
};

/// A question of the table. Linked by hedgerow::any, for float and double, in two and three dimensions.
template <std::floating_point T, int D>
class AnyQuestion {
public:
    virtual ~AnyQuestion() = default;

    virtual const QuestionInfo& info() const = 0;
    virtual bool answered_by(const AnyIndex<T, D>& index) const = 0;
    /// Answers `count` rows of the question's columns, the first of which is number `first`, in the calling
    /// thread. A row that can have no answer (RowsOf::usable) has what stands for none, or an empty list.
    virtual void answer(const RowsAsked<T, D>& asked, const T* rows, std::uint64_t first, std::size_t count,
                        AnsweredRows& answers) const = 0;
};

/// All questions, in the order of the table.
template <std::floating_point T, int D>
std::span<const AnyQuestion<T, D>* const> any_questions();
/// The question of a name and variant, or nullptr. O(log n).
template <std::floating_point T, int D>
const AnyQuestion<T, D>* any_question(std::string_view name, std::string_view variant = {});

}  // namespace hedgerow

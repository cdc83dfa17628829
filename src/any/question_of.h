/// Implements AnyQuestion for each question of the table.
#pragma once

#include <algorithm>
#include <map>
#include <memory>

#include <hedgerow/any_question.h>

namespace hedgerow::detail {

template <class Answer>
inline constexpr bool is_list = false;
template <class Item>
inline constexpr bool is_list<std::vector<Item>> = true;

/// An index whose ids are the positions, for the columns of answers that are not there yet.
struct NoIndex {
    std::uint32_t id(PrimitiveId element) const { return element; }
};

/// Passes columns on to `to`, a record or what counts its bytes; primitives by the reader's numbers.
template <class To>
struct ByNumbers {
    To& to;
    std::span<const std::uint32_t> numbers;

    template <class N>
    void operator()(std::string_view name, N value) {
        if constexpr (std::is_same_v<N, std::uint32_t>)
            if (name == "primitive" && value < numbers.size()) value = numbers[value];
        to(name, value);
    }
};

template <class Question, std::floating_point T, int D>
class QuestionOf final : public AnyQuestion<T, D> {
public:
    using Given = typename Question::Given;
    using Answer = typename Question::Answer;
    using Rows = RowsOf<Given>;

    const QuestionInfo& info() const override { return info_; }
    bool answered_by(const AnyIndex<T, D>& index) const override {
        const bool of_points = std::holds_alternative<PointCloudView<T, D>>(index.set());
        return answers<Question>(index) && !(info_.of_rays && of_points);
    }
    void answer(const RowsAsked<T, D>& asked, const T* rows, std::uint64_t first, std::size_t count,
                AnsweredRows& answers) const override {
        if (info_.of_solid && asked.solid == nullptr)
            throw UsageError(std::string(info_.name) +
                             " is asked of a solid: AnyIndex::make_solid makes that of the index");
        if constexpr (is_list<Answer>)
            answer_by_lists(asked, rows, first, count, answers);
        else
            answer_by_rows(asked, rows, first, count, answers);
    }

private:
    void answer_by_lists(const RowsAsked<T, D>& asked, const T* rows, std::uint64_t first, std::size_t count,
                         AnsweredRows& answers) const {
        const Scratch<Answer> found;
        for (std::size_t i = 0; i < count; ++i) {
            const T* const row = rows + i * info_.asked.size();
            if (!Rows::usable(row)) {
                answers.refuse(first + i);
                continue;
            }
            Question::ask(asked.index, Rows::of(row, asked.options), *found);
            for (const auto& item : *found)
                append_record(answers.records, [&](Record& record) {
                    record("query", first + i);
                    ByNumbers<Record> numbered{record, asked.numbers};
                    list_item_columns(asked.index, item, numbered);
                });
            answers.rows += found->size();
        }
    }
    void answer_by_rows(const RowsAsked<T, D>& asked, const T* rows, std::uint64_t first, std::size_t count,
                        AnsweredRows& answers) const {
        const Scratch<std::vector<Given>> all;
        const Scratch<Answers> kept;
        const std::span<Answer> found = kept->of(count);
        const auto row = [&](std::size_t i) { return rows + i * info_.asked.size(); };
        all->clear();
        for (std::size_t i = 0; i < count; ++i) all->push_back(Rows::of(row(i), asked.options));
        ask_all(asked, *all, found);
        const Answer none = no_answer<Question>();
        const auto list = [&]<class R>(const Answer& answer, R& record) {
            ByNumbers<R> numbered{record, asked.numbers};
            list_answer<Question>(answer, numbered);
        };
        RecordSize size;
        list(none, size);
        append_records(answers.records, count, size.bytes, [&](std::size_t i, Record& record) {
            const bool usable = Rows::usable(row(i));
            if (!usable) answers.refuse(first + i);
            list(usable ? found[i] : none, record);
        });
        answers.rows += count;
    }
    /// Memory for answers, which may be bool.
    struct Answers {
        std::unique_ptr<Answer[]> all;
        std::size_t room = 0;

        std::span<Answer> of(std::size_t count) {
            if (room < count) all.reset(new Answer[count]), room = count;
            return {all.get(), count};
        }
    };
    static void ask_all(const RowsAsked<T, D>& asked, std::span<const Given> given, std::span<Answer> found) {
        if constexpr (AsksSolid<Question>)
            Question::ask_solid(*asked.solid, given, found);
        else if constexpr (TakesPointOptions<Question, T, D>)
            Question::ask_all(asked.index, given, found, {}, asked.options.template near<T>());
        else if constexpr (AsksMany<Question>)
            Question::ask_all(asked.index, given, found);
        else
            for (std::size_t i = 0; i < given.size(); ++i) Question::ask(asked.index, given[i], found[i]);
    }

    static QuestionInfo describe() {
        QuestionInfo info{.name = Question::name,
                          .variant = variant_of<Question>(),
                          .words = Question::words,
                          .meaning = Question::meaning,
                          .function = Question::function,
                          .batch = Question::batch,
                          .asked = Rows::columns(),
                          .answered = {},
                          .lists = is_list<Answer>,
                          .options = {},
                          .of_rays = is_ray<Given>,
                          .of_facets = AsksFacets<Question>,
                          .of_solid = AsksSolid<Question>};
        ColumnList columns;
        if constexpr (is_list<Answer>) {
            columns("query", std::uint64_t());
            list_item_columns(NoIndex(), typename Answer::value_type(), columns);
        } else {
            list_answer<Question>(Answer(), columns);
        }
        info.answered = std::move(columns.all);
        RowOptions standard;
        OptionInfos options;
        list_row_options<Question, T, D>(standard, options);
        for (OptionInfo& option : options.all)
            info.options.push_back({std::move(option), (option.name == "count" && Rows::needs_count) ||
                                                           (option.name == "radius" && Rows::needs_radius)});
        return info;
    }

    QuestionInfo info_ = describe();
};

/// The table of one scalar and dimension.
template <std::floating_point T, int D>
class QuestionTable {
public:
    using Any = AnyQuestion<T, D>;

    static const QuestionTable& get() {
        static const QuestionTable table;
        return table;
    }
    std::span<const Any* const> all() const { return all_; }
    const Any* find(std::string_view name, std::string_view variant) const {
        const auto found = by_name_.find({name, variant});
        return found == by_name_.end() ? nullptr : found->second;
    }

private:
    QuestionTable() {
        for_each_question<T, D>([&]<class Question>(Question) {
            const Any& question = *owned_.emplace_back(std::make_unique<QuestionOf<Question, T, D>>());
            all_.push_back(&question);
            by_name_.emplace(std::pair(question.info().name, question.info().variant), &question);
        });
    }

    std::vector<std::unique_ptr<const Any>> owned_;
    std::vector<const Any*> all_;
    std::map<std::pair<std::string_view, std::string_view>, const Any*> by_name_;
};

}  // namespace hedgerow::detail

namespace hedgerow {

template <std::floating_point T, int D>
std::span<const AnyQuestion<T, D>* const> any_questions() {
    return detail::QuestionTable<T, D>::get().all();
}
template <std::floating_point T, int D>
const AnyQuestion<T, D>* any_question(std::string_view name, std::string_view variant) {
    return detail::QuestionTable<T, D>::get().find(name, variant);
}

}  // namespace hedgerow

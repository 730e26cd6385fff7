"""A prairie's entities: guests in the game's own world (D2, D6)."""

import gc
from dataclasses import dataclass

import esper
import pytest

from tallgrass.engine.world import Resident, World


@dataclass
class Grass:
    height: float


@dataclass
class Reed(Grass):
    pass


@dataclass
class Score:
    points: int


def test_d2_an_entity_has_the_components_it_was_created_with(world: World) -> None:
    entity = world.create(Grass(0.5), Score(3))
    assert (world.find(entity, Grass), world.find(entity, Score)) == (Grass(0.5), Score(3))
    assert esper.component_for_entity(entity, Grass) is world.find(entity, Grass)


def test_a_component_added_again_takes_the_old_ones_place(world: World) -> None:
    entity = world.create(Grass(0.5))
    world.add(entity, Grass(0.7))
    assert [grass.height for _, grass in world.all(Grass)] == [0.7]


def test_a_missing_component_is_none(world: World) -> None:
    assert world.find(world.create(Grass(0.5)), Score) is None


def test_changes_count_what_a_game_does_but_not_what_is_exchanged(world: World) -> None:
    theirs = esper.create_entity(Grass(0.9))
    counted = [world.changes()]
    for change in (
        lambda: esper.create_entity(Score(1)),
        lambda: esper.add_component(theirs, Grass(0.8)),
        lambda: esper.remove_component(theirs, Grass),
        lambda: esper.delete_entity(theirs, immediate=True),
        lambda: world.create(Score(2)),
    ):
        assert world.changes() == counted[-1]
        change()
        counted.append(world.changes())
        with world.exchanging():
            world.delete(world.create(Grass(0.1)))
    assert counted == [*range(counted[0], counted[0] + 6)]
    esper.create_entity(Score(3))
    with world.exchanging():  # a change before it is not forgotten
        world.create(Grass(0.2))
    assert world.changes() == counted[-1] + 1


def test_components_beside_others_are_found_in_their_order(world: World) -> None:
    for grass, score in ((0.1, 1), (0.2, None), (0.3, 3)):
        world.create(Grass(grass), *([] if score is None else [Score(score)]))
    rows = world.rows(Grass)
    assert world.beside(rows, Score) == [{0.1: Score(1), 0.2: None, 0.3: Score(3)}[grass.height] for _, grass in rows]


def test_components_are_found_by_their_exact_type_and_by_rising_entity(world: World) -> None:
    entities = [world.create(Grass(number / 10)) for number in range(20)]
    world.create(Reed(2.0))
    for gone in entities[3:12:2]:
        world.delete(gone)
    entities += [world.create(Grass(number / 10)) for number in range(20, 25)]
    kept = [entity for entity in entities if entity not in entities[3:12:2]]
    assert [entity for entity, _ in world.all(Grass)] == kept
    assert [grass.height for _, grass in world.all(Grass)] == [entities.index(entity) / 10 for entity in kept]


def test_d2_the_games_own_entities_with_our_components_are_found_too(world: World) -> None:
    theirs = esper.create_entity(Grass(0.9))
    assert world.all(Grass) == [(theirs, Grass(0.9))]
    assert len(world) == 0


def test_what_is_asked_for_may_be_kept_while_the_world_changes(world: World) -> None:
    world.create(Grass(0.5))
    found = world.all(Grass)
    found.clear()
    world.create(Grass(0.6))
    assert len(world.all(Grass)) == 2


def test_d2_a_deleted_entity_is_gone_at_once(world: World) -> None:
    entity = world.create(Grass(0.5))
    world.delete(entity)
    assert not esper.entity_exists(entity)
    assert world.all(Grass) == []
    assert len(world) == 0


def test_an_entity_that_the_game_has_deleted_may_be_deleted_again(world: World) -> None:
    entity = world.create(Grass(0.5))
    esper.delete_entity(entity, immediate=True)
    world.delete(entity)
    world.delete(entity)
    esper.process()
    assert len(world) == 0


def test_d2_release_removes_our_entities_and_leaves_the_games_own(world: World) -> None:
    theirs = [esper.create_entity(Score(number)) for number in range(3)]
    for _ in range(5):
        world.create(Grass(0.5), Score(0))
    world.release()
    assert len(world) == 0
    assert sorted(esper.get_entities()) == theirs
    assert [score.points for _, score in esper.get_component(Score)] == [0, 1, 2]
    assert esper.get_component(Grass) == []


def test_what_a_prairie_left_that_was_dropped_without_release_is_not_taken_for_the_games(world: World) -> None:
    dropped = World()
    left = dropped.create(Grass(0.6))
    del dropped
    gc.collect()
    assert esper.entity_exists(left)
    assert world.all(Grass) == []


def test_two_prairies_in_one_world_do_not_see_each_others_entities(world: World) -> None:
    other = World()
    mine, others, theirs = world.create(Grass(0.5)), other.create(Grass(0.6)), esper.create_entity(Grass(0.7))
    assert [entity for entity, _ in world.all(Grass)] == [mine, theirs]
    assert [entity for entity, _ in other.all(Grass)] == [others, theirs]
    other.release()
    assert [entity for entity, _ in world.all(Grass)] == [mine, theirs]


def test_two_prairies_in_one_world_release_each_its_own(world: World) -> None:
    other = World()
    mine, others = world.create(Grass(0.5)), other.create(Grass(0.6))
    world.release()
    assert not esper.entity_exists(mine)
    assert esper.entity_exists(others)
    other.release()


def test_our_entities_go_through_the_worlds_own_processing(world: World) -> None:
    entity = world.create(Grass(0.5))
    esper.process()
    assert world.find(entity, Grass) == Grass(0.5)


def test_no_entity_of_another_world_is_ever_touched(world: World, elsewhere: str) -> None:
    esper.switch_world(world.name)
    ours = world.create(Grass(0.5))
    esper.switch_world(elsewhere)
    theirs = [esper.create_entity(Score(1)) for _ in range(ours)][-1]
    assert theirs == ours, "worlds number their entities alike"
    for act in (lambda: world.delete(ours), lambda: world.create(Grass(0.1)), lambda: world.all(Grass)):
        with pytest.raises(RuntimeError, match=rf"esper world '{world.name}'.*'{elsewhere}'"):
            act()
    world.release()
    assert esper.component_for_entity(theirs, Score).points == 1
    assert esper.get_component(Grass) == []


def test_d6_entities_of_a_world_that_is_not_current_go_with_release_too(world: World, elsewhere: str) -> None:
    esper.switch_world(world.name)
    theirs = [esper.create_entity(Score(1)), world.create(Grass(0.5))][0]
    esper.switch_world(elsewhere)
    menu = esper.create_entity(Score(7))
    world.release()
    assert esper.current_world == elsewhere
    assert list(esper.get_entities()) == [menu]
    esper.switch_world(world.name)
    assert list(esper.get_entities()) == [theirs]
    esper.switch_world(elsewhere)


def test_d6_a_world_that_the_game_has_deleted_is_not_made_again(world: World) -> None:
    esper.switch_world("level")
    level = World()
    level.create(Grass(0.5))
    esper.switch_world(world.name)
    esper.delete_world("level")
    level.release()
    assert "level" not in esper.list_worlds()


def test_d6_after_a_game_clears_its_world_its_new_entities_are_not_taken_for_ours(world: World) -> None:
    ours = world.create(Grass(0.5))
    esper.clear_database()
    theirs = [esper.create_entity(Score(3)) for _ in range(ours)][-1]
    assert theirs == ours, "a cleared world counts from 1 again"
    world.delete(ours)
    world.release()
    assert esper.component_for_entity(theirs, Score).points == 3


def test_d6_a_game_can_tell_a_prairies_entities_from_its_own(world: World) -> None:
    theirs = esper.create_entity(Grass(0.5))
    ours = {world.create(Grass(0.5)), world.create(Score(1))}
    residents = {entity for entity, _ in esper.get_component(Resident)}
    assert residents >= ours
    assert residents == set(esper.get_entities()) - {theirs}


# ---- What somebody else deletes ------------------------------------------------------------------


@pytest.mark.parametrize("at_once", [True, False])
def test_an_entity_of_ours_that_somebody_else_deletes_is_told_of_once(world: World, *, at_once: bool) -> None:
    kept, gone = world.create(Grass(0.5)), world.create(Grass(0.6))
    assert world.lost() == []
    esper.delete_entity(gone, immediate=at_once)
    assert world.lost() == [gone], "also if esper puts the deletion off"
    assert world.lost() == []
    esper.process()
    assert world.lost() == []
    assert gone not in world
    assert kept in world
    assert len(world) == 1
    assert world.generation == 0


def test_all_that_were_deleted_are_told_of_in_their_order(world: World) -> None:
    entities = [world.create(Grass(0.5)) for _ in range(6)]
    for gone in (entities[4], entities[1], entities[2]):
        esper.delete_entity(gone, immediate=True)
    assert world.lost() == [entities[4], entities[1], entities[2]]


def test_entities_with_two_components_are_found_by_rising_number_and_no_others(world: World) -> None:
    first, _, last = world.create(Grass(0.5), Score(1)), world.create(Grass(0.5)), world.create(Grass(0.7), Score(2))
    assert [(entity, grass.height) for entity, grass, _ in world.both(Grass, Score)] == [(first, 0.5), (last, 0.7)]


def test_what_a_game_has_deleted_is_gone_at_once_even_if_esper_still_defers_that(world: World) -> None:
    ours, theirs = world.create(Grass(0.5), Score(1)), esper.create_entity(Grass(0.6), Score(2))
    for gone in (ours, theirs):
        esper.delete_entity(gone)
    assert (world.all(Grass), world.both(Grass, Score)) == ([], [])


def test_d6_esper_can_still_delete_what_a_game_deleted_before_the_release(world: World) -> None:
    entities = [world.create(Grass(0.5)) for _ in range(3)]
    esper.delete_entity(entities[1])
    world.release()
    esper.process()
    assert list(esper.get_entities()) == []


def test_what_we_delete_ourselves_is_not_lost(world: World) -> None:
    ours = [world.create(Grass(0.5)) for _ in range(3)]
    world.delete(ours[0])
    assert world.lost() == []
    world.release()
    assert world.lost() == []


def test_the_games_own_entities_and_another_prairies_are_not_our_loss(world: World) -> None:
    other = World()
    world.create(Grass(0.5))
    theirs, others = esper.create_entity(Grass(0.5)), other.create(Grass(0.6))
    for gone in (theirs, others):
        esper.delete_entity(gone, immediate=True)
    assert world.lost() == []
    assert other.lost() == [others]
    other.release()


def test_a_component_that_comes_or_goes_is_no_loss(world: World) -> None:
    entity = world.create(Grass(0.5))
    world.add(entity, Grass(0.6))
    esper.remove_component(entity, Grass)
    assert world.lost() == []
    assert entity in world


def test_a_game_that_has_just_looked_at_our_marks_is_heard_when_it_has_looked_again(world: World) -> None:
    entity = world.create(Grass(0.5))
    assert esper.get_component(Resident)  # esper keeps what it answered until it is asked again
    esper.delete_entity(entity, immediate=True)
    world.all(Grass)
    assert world.lost() == [entity]


# ---- A world that is cleared ---------------------------------------------------------------------


def test_d6_a_world_that_was_cleared_is_of_another_generation_and_loses_nothing_singly(world: World) -> None:
    ours = [world.create(Grass(0.5)) for _ in range(4)]
    esper.delete_entity(ours[2], immediate=True)
    esper.clear_database()
    assert world.lost() == []
    assert world.check() == world.generation == 1
    assert len(world) == 0
    assert not any(entity in world for entity in ours)
    assert world.check() == 1


def test_d6_each_time_that_a_world_is_cleared_counts_and_between_two_times_losses_are_told(world: World) -> None:
    for generation in range(1, 4):
        kept, gone = world.create(Grass(0.5)), world.create(Grass(0.6))
        esper.delete_entity(gone, immediate=True)
        assert world.lost() == [gone]
        assert kept in world
        esper.clear_database()
        assert world.check() == generation
        assert world.lost() == []


def test_d6_nobody_needs_to_ask_between_clearing_and_creating(world: World) -> None:
    for generation in range(1, 4):
        world.create(Grass(0.5))
        esper.clear_database()
        new = world.create(Grass(0.6))
        assert world.generation == generation
        assert world.lost() == []
        assert new in world


def test_d6_a_world_in_which_nothing_of_ours_was_is_cleared_without_notice(world: World) -> None:
    esper.create_entity(Score(1))
    esper.clear_database()
    assert world.check() == 0


def test_d6_clearing_another_world_is_no_loss(world: World, elsewhere: str) -> None:
    esper.switch_world(world.name)
    ours = world.create(Grass(0.5))
    esper.switch_world(elsewhere)
    esper.create_entity(Score(1))
    esper.clear_database()
    assert world.lost() == []
    assert world.check() == 0
    assert ours in world


def test_d6_an_entity_number_that_is_used_again_is_not_mistaken(world: World) -> None:
    old = [world.create(Grass(0.5)) for _ in range(3)]
    esper.clear_database()
    new = [world.create(Grass(0.6)) for _ in range(3)]
    assert new == old, "a cleared world counts from 1 again"
    assert world.lost() == []
    assert all(entity in world for entity in new)
    esper.delete_entity(new[1], immediate=True)
    assert world.lost() == [new[1]]
    assert len(world) == 2


def test_d6_a_mark_that_outlives_its_entity_does_not_take_the_next_of_that_number_with_it(world: World) -> None:
    old = world.create(Grass(0.5))
    mark = esper.component_for_entity(old, Resident)
    esper.clear_database()
    new = world.create(Grass(0.6))
    assert new == old, "a cleared world counts from 1 again"
    del mark
    assert world.lost() == []
    assert new in world
    world.delete(new)
    assert not esper.entity_exists(new)


def test_d6_a_number_that_is_the_games_by_now_is_left_alone(world: World) -> None:
    ours = world.create(Grass(0.5))
    esper.clear_database()
    theirs = [esper.create_entity(Score(3)) for _ in range(ours)]
    assert ours in theirs
    assert ours not in world
    esper.delete_entity(ours, immediate=True)
    assert world.lost() == []

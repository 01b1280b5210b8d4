"""Toys that break one law each: laws of inactive items, steps, state and accounts."""

from typing import ClassVar

import numpy as np
from toy_planting import breaks
from toy_sound import STATE, Sound

from quintet.coupler.conform.laws import accounts, activity, state, time_steps
from quintet.interfaces.component import ONE_THREAD, Totals


@breaks(activity.flags_are_zero_or_one)
class FlagIsBetween(Sound):
    def outputs(self):
        return {**super().outputs(), "flight.active": 0.5 * self.active}


@breaks(activity.flags_are_zero_or_one)
class TheDeadComeBack(Sound):
    def step(self, dt):
        super().step(dt)
        if self.clock[0] % 3 == 0:
            self.active = np.ones_like(self.active)


@breaks(activity.outputs_of_inactive_items_are_zero)
class PushesWhatIsInactive(Sound):
    def drags(self):
        return self.volume[:, None] * (self.v[0] - self.cloud)


@breaks(activity.inputs_of_inactive_items_change_nothing)
class TheDeadFeelTheirLoad(Sound):
    def step(self, dt):
        active, self.active = self.active, np.ones_like(self.active)
        super().step(dt)
        self.active = self.active * active


@breaks(time_steps.the_stable_step_is_positive)
class NoStepIsStable(Sound):
    def stable_dt(self):
        return 0.0


@breaks(time_steps.the_stable_step_is_positive)
class StableStepIsNoNumber(Sound):
    def stable_dt(self):
        return float("nan")


@breaks(time_steps.the_stable_step_is_positive)
class StableStepChangesAsItIsAsked(Sound):
    asked = 0

    def stable_dt(self):
        self.asked += 1
        return super().stable_dt() / self.asked


@breaks(time_steps.the_stable_step_is_the_same_after_load)
class StableStepIsNotSaved(Sound):
    largest = 1.0

    def step(self, dt):
        super().step(dt)
        self.largest = 0.9 * self.largest

    def stable_dt(self):
        return self.largest * super().stable_dt()


@breaks(time_steps.stable_steps_stay_finite)
class StableStepIsTooLong(Sound):
    def stable_dt(self):
        return 1e4


@breaks(time_steps.two_half_steps_come_to_one)
class StepsByItsOwnStep(Sound):
    def step(self, dt):
        super().step(1e-3)


@breaks(accounts.momentum_changes_by_the_impulses)
class GivesIntegralsForRates(Sound):
    def step(self, dt):
        super().step(dt)
        self.drag = dt * self.drag


@breaks(state.the_same_inputs_give_the_same_bits)
class RandomWithoutASeed(Sound):
    def noise(self):
        return self.params.noise * np.random.default_rng().normal(size=self.x.shape)


@breaks(state.instances_share_no_state)
class StateOfTheClass(Sound):
    kicks: ClassVar[list[float]] = []

    def __init__(self, params, resources=ONE_THREAD):
        super().__init__(params, resources)
        self.kicks.clear()

    def step(self, dt):
        super().step(dt)
        self.kicks.append(1e-9)
        self.x = self.x + sum(self.kicks) * (np.abs(self.v).max() > 0.0)


@breaks(state.load_then_repeat_gives_the_same_bits)
class ForgetsStateInSave(Sound):
    def save(self):
        return {key: array for key, array in super().save().items() if key != "spin"}

    def load(self, state):
        super().load({"spin": self.spin, **state})


@breaks(state.save_changes_nothing)
class SaveRounds(Sound):
    def save(self):
        self.v = np.round(self.v, 4)
        return super().save()


@breaks(state.what_is_saved_crosses_a_line)
class SavesAnObject(Sound):
    def save(self):
        return {**super().save(), "params": np.array(self.params, dtype=object)}


@breaks(state.what_is_saved_does_not_change_afterwards)
class SavesItsOwnArrays(Sound):
    def step(self, dt):
        old_position, x = self.x, self.x
        super().step(dt)
        old_position[...], self.x = self.x, x

    def save(self):
        return {key: getattr(self, key) for key in STATE}


@breaks(state.what_is_loaded_is_neither_written_to_nor_kept)
class LoadKeepsReferences(Sound):
    def load(self, state):
        super().load(state)
        self.v = state["v"]


@breaks(state.what_is_loaded_is_neither_written_to_nor_kept)
class WritesIntoWhatItLoads(Sound):
    def load(self, state):
        state["v"][...] += 0.0
        super().load(state)


@breaks(state.warnings_are_those_of_the_state)
class WarnsOfStepsThatItDoesNotSave(Sound):
    steps = 0

    def step(self, dt):
        super().step(dt)
        self.steps += 1

    def warnings(self):
        return {"steps": f"it made {self.steps} steps"} if self.steps else {}


@breaks(state.final_warnings_change_nothing)
class FinalWarningsAreNoTexts(Sound):
    def final_warnings(self):
        return {"steps": 7}


@breaks(state.final_warnings_change_nothing)
class RestsWhenItIsJudged(Sound):
    def final_warnings(self):
        self.v = 0.0 * self.v
        return {}


@breaks(accounts.it_counts_what_it_advances_and_what_it_holds)
class CountsNothing(Sound):
    def items(self):
        return 0


@breaks(accounts.it_counts_what_it_advances_and_what_it_holds)
class NegativeEnergy(Sound):
    def totals(self):
        return Totals(1.0, np.zeros(3), np.zeros(3), -1.0)


@breaks(accounts.it_counts_what_it_advances_and_what_it_holds)
class MissesMass(Sound):
    def totals(self):
        totals = super().totals()
        totals.mass_balance = {"at the start": totals.mass, "entered": 0.1 * totals.mass}
        return totals


@breaks(accounts.momentum_changes_by_the_impulses)
class FeelsNoReaction(Sound):
    def step(self, dt):
        drag = self.drags().sum(axis=0)
        super().step(dt)
        self.v[0] += dt * drag / self.params.mass


@breaks(accounts.views_are_pictures)
class PointsInAPlane(Sound):
    def view(self):
        return {"points": self.x[:, :2].copy()}

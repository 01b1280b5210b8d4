"""The laws of the contract, in the order in which they are tried."""

from collections.abc import Callable

from quintet.coupler.conform.laws import (
    accounts,
    activity,
    declarations,
    inputs,
    outputs,
    state,
    time_steps,
)
from quintet.coupler.conform.trial import Trial

Law = Callable[[Trial], None]

FIRST = declarations.it_is_made_and_joined  # without it no other can be tried
READ_ONLY = inputs.received_arrays_are_neither_written_to_nor_kept
LAWS: tuple[Law, ...] = (
    FIRST,
    state.the_same_inputs_give_the_same_bits,  # else what compares two of them says little
    READ_ONLY,
    declarations.its_ports_are_those_of_its_manifest,
    declarations.names_are_told_apart,
    declarations.units_fit_each_other,
    declarations.describe_tells_what_its_ports_announce,
    declarations.it_is_made_with_resources_or_without,
    inputs.ports_may_be_left_unjoined,
    inputs.alone_it_runs_and_gives_nothing,
    outputs.outputs_match_their_ports,
    outputs.just_what_is_wanted_is_given,
    outputs.what_else_is_wanted_changes_no_bit,
    outputs.the_number_of_items_never_changes,
    outputs.outputs_are_copies,
    outputs.at_rest_nothing_comes_out,
    outputs.values_follow_their_rates,
    outputs.rotations_are_unit_quaternions,
    activity.flags_are_zero_or_one,
    activity.outputs_of_inactive_items_are_zero,
    activity.inputs_of_inactive_items_change_nothing,
    time_steps.the_stable_step_is_positive,
    time_steps.the_stable_step_is_the_same_after_load,
    time_steps.stable_steps_stay_finite,
    time_steps.two_half_steps_come_to_one,
    state.instances_share_no_state,
    state.load_then_repeat_gives_the_same_bits,
    state.save_changes_nothing,
    state.what_is_saved_crosses_a_line,
    state.what_is_saved_does_not_change_afterwards,
    state.what_is_loaded_is_neither_written_to_nor_kept,
    state.warnings_are_those_of_the_state,
    state.final_warnings_change_nothing,
    accounts.it_counts_what_it_advances_and_what_it_holds,
    accounts.momentum_changes_by_the_impulses,
    accounts.views_are_pictures,
)


def name_of(law: Law) -> str:
    """A law in words."""
    return law.__name__.replace("_", " ")

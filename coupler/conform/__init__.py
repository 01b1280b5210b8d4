"""``quintet conform KIND``: the laws of the contract, tried on any component.

``laws`` are functions of a `Trial`, which makes the component afresh for each of them; what breaks
a law raises `LawBroken`, a law that says nothing of a component raises `DoesNotApply`. A kind says
what it is tried with as `ConformCase`, or a scene does.
"""

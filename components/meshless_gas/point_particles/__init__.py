"""Particles that are smaller than the spacing of the nodes: drag and heat by correlations.

    F = 3π μ d f(Re, M, …) (u - v),   Q = π λ d Nu (T - T_p),   C_D = 24 f/Re

Gas at a particle is the mean of nearby nodes by a compact kernel; what the particle gets these
nodes lose, by the same weights: -F, and the energy F·v + Q.

Papers: Clift & Gauvin, Proc. Chemeca 70 (1970) 14; Henderson, AIAA J. 14 (1976) 707; Loth et al.,
AIAA J. 59 (2021) 3261; Ranz & Marshall, Chem. Eng. Prog. 48 (1952) 141; Fox, Rackett & Nicholls,
Shock Tube and Shock Wave Research (1978) 262.
"""

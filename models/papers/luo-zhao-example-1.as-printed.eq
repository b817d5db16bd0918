# Luo & Zhao, example 1: the equations as printed, with their misprints.
# Names are those of luo-zhao-example-1.toml; lambda is the multiplier of the only constraint.
# Equations whose print is not known in detail have the corrected form, and a comment says so.

# The square of the relative speed; (4.1) and (4.2) contain the same sum, once in the constraint and once in T_r.
# Misprint: c is also the speed; cos(psi)^2 is meant.
4.1: r'^2 + r^2*psi'^2 + r^2*c^2*phi'^2 = c^2
# Routh's equations for r, psi (latitude), phi (longitude). How the terms of (4.3) are arranged in print is not known here:
# every line means the equation as a whole.
# Not marked as wrong: corrected form. (The text before has Q^R = m u for m' u, in all three.)
4.3.r: m*(r'' - r*psi'^2 - r*cos(psi)^2*phi'^2) = -k2*m/r^2 + m'*ur + m*w^2*r*cos(psi)^2 + 2*m*w*r*cos(psi)^2*phi' + 2*lambda*r'
# Misprint in the last term: 2*r^2*psi'*lambda is meant. (Gamma_psi in the text before is misprinted too, here it is right.)
4.3.psi: m*(r^2*psi'' + 2*r*r'*psi' + r^2*sin(psi)*cos(psi)*phi'^2) = m'*r*up - m*w^2*r^2*sin(psi)*cos(psi) - 2*m*w*r^2*phi'*sin(psi)*cos(psi) + 2*r*psi'^2*lambda
# Not marked as wrong: corrected form.
4.3.phi: m*(r^2*cos(psi)^2*phi'' + 2*r*r'*cos(psi)^2*phi' - 2*r^2*sin(psi)*cos(psi)*psi'*phi') = m'*r*cos(psi)*uf - 2*m*w*r*r'*cos(psi)^2 + 2*m*w*r^2*sin(psi)*cos(psi)*psi' + 2*r^2*cos(psi)^2*phi'*lambda
# (4.4) is not given here: what it says is not known from the notes these files were written from.
